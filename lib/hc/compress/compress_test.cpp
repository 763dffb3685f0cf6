// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/compress.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <hc/mtp/matrix_view.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

Message gradient(std::uint8_t components) {
  Info info{components == 1 ? MatrixType::IntensityImage : MatrixType::RgbImage, components,
            Scalar::U8, Encoding::Binary};
  Draft draft = Draft::make(info, 48, 64);
  auto pixels = view<std::uint8_t>(draft);
  for (std::size_t y = 0; y < 48; ++y)
    for (std::size_t x = 0; x < 64; ++x)
      for (std::size_t k = 0; k < components; ++k)
        pixels.at(y, x, k) = static_cast<std::uint8_t>(2 * x + y + 20 * k);
  return std::move(draft).finish();
}

TEST(Compress, ZstdKeepsEveryBit) {
  Message image = gradient(3);
  auto packed = must(compress(image, Encoding::Zstd));
  EXPECT_LT(packed.elements.size(), image.elements.size());
  auto again = must(expand(packed));
  EXPECT_EQ(again.text(), image.text());
  EXPECT_EQ(again.header, image.header);
}

TEST(Compress, JpegKeepsTheImage) {
  for (int components : {1, 3}) {
    Message image = gradient(static_cast<std::uint8_t>(components));
    auto packed = must(compress(image, Encoding::Jpeg));
    EXPECT_LT(packed.elements.size(), image.elements.size() / 2);
    auto again = must(expand(packed));
    auto numbers = view<std::uint8_t>(again)->numbers(),
         wanted = view<std::uint8_t>(image)->numbers();
    double squares = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      squares += std::pow(numbers[i] - wanted[i], 2) / static_cast<double>(numbers.size());
    EXPECT_LT(std::sqrt(squares), 3) << "grey levels, root mean square, at quality 90";
  }
}

TEST(Compress, BetweenAllEncodings) {
  Message image = gradient(1);
  auto jpeg = compress(image, Encoding::Jpeg);
  auto zstd = must(compress(*jpeg, Encoding::Zstd));
  EXPECT_EQ(expand(zstd)->text(), expand(*jpeg)->text());
  auto text = compress(zstd, Encoding::Text);
  EXPECT_EQ(text->header.info.encoding, Encoding::Text);
  EXPECT_EQ(compress(*jpeg, Encoding::Jpeg)->elements.data(), jpeg->elements.data());
}

TEST(Compress, R21_JpegIsForImages) {
  Message table = std::move(Draft::make(Info(), 1, 1)).finish();
  const auto error = refused(compress(table, Encoding::Jpeg));
  EXPECT_EQ(error.code, Code::Unsupported);
  EXPECT_TRUE(error.detail.starts_with("R21"));
}

TEST(Compress, EmptyMatrices) {
  Message empty =
      std::move(Draft::make({MatrixType::Table, 1, Scalar::F64, Encoding::Binary}, 3, 0)).finish();
  auto packed = must(compress(empty, Encoding::Zstd));
  EXPECT_TRUE(expand(packed)->elements.empty());
}

TEST(CheckJpeg, EveryCutIsFound) {
  const Message packed = must(compress(gradient(3), Encoding::Jpeg));
  const auto file = packed.elements;
  EXPECT_TRUE(check_jpeg(file));
  for (std::size_t size = 0; size < file.size(); ++size)
    EXPECT_FALSE(check_jpeg(file.first(size))) << size;
}

TEST(CheckJpeg, DamageIsFoundAndWhatFollowsTheImageIsIgnored) {
  const Message packed = must(compress(gradient(1), Encoding::Jpeg));
  const auto file = packed.elements;
  std::vector<std::byte> bytes(file.begin(), file.end());
  bytes.insert(bytes.end(), 100, std::byte(7));
  EXPECT_TRUE(check_jpeg(bytes));
  // A marker amid the pixels.
  bytes[file.size() / 2 + 100] = std::byte(0xff);
  bytes[file.size() / 2 + 101] = std::byte(0xd9);
  EXPECT_FALSE(check_jpeg(bytes));
}

TEST(CheckJpeg, AnImageMayBeFilledUp) {
  std::mt19937 random{1};
  for (int seed = 0; seed < 300; ++seed) {
    Draft draft = Draft::make({MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary},
                              8 + static_cast<std::int32_t>(random() % 40), 8 + seed % 30);
    for (auto& each : draft.elements()) each = std::byte(random() % 256);
    const Message packed = must(compress(std::move(draft).finish(), Encoding::Jpeg));
    std::vector<std::byte> bytes(packed.elements.begin(), packed.elements.end());
    bytes.insert(bytes.end() - 2, 1 + random() % 40, std::byte(seed % 2));  // before the end marker
    EXPECT_TRUE(check_jpeg(bytes)) << seed;
  }
}

TEST(CheckJpeg, PixelsThatAreLeftOverAreDamage) {
  const Message packed = must(compress(gradient(3), Encoding::Jpeg));
  const auto with = [&](const std::vector<std::byte>& added) {
    std::vector<std::byte> bytes(packed.elements.begin(), packed.elements.end());
    bytes.insert(bytes.end() - 2, added.begin(), added.end());  // before the end marker
    return bytes;
  };
  EXPECT_TRUE(check_jpeg(with(std::vector<std::byte>(30))));
  std::vector<std::byte> pixels;
  for (std::uint8_t i = 0; i < 30; ++i) pixels.push_back(std::byte(i));
  const auto damaged = check_jpeg(with(pixels));
  ASSERT_FALSE(damaged);
  EXPECT_TRUE(damaged.error().detail.starts_with("Corrupt JPEG data: "));
}

TEST(Expand, R36_R37_EveryCutIsRefused) {
  for (Encoding encoding : {Encoding::Zstd, Encoding::Jpeg}) {
    auto packed = compress(gradient(1), encoding);
    for (std::size_t size = 0; size < packed->elements.size(); size += 7) {
      Message cut = *packed;
      cut.elements = cut.elements.first(size);
      EXPECT_FALSE(expand(cut)) << size;
    }
  }
}

TEST(Expand, R36_R37_NoMemoryIsSetAsideForWhatCannotCome) {
  for (Encoding encoding : {Encoding::Zstd, Encoding::Jpeg}) {
    Message message;
    message.header.info = {MatrixType::IntensityImage, 1, Scalar::U8, encoding};
    message.header.width = message.header.height = 16000;
    std::array<std::byte, 200> bytes{};
    message.elements = bytes;
    const auto expanded = refused(expand(message));
    EXPECT_NE(expanded.detail.find("200 compressed bytes cannot expand to the header's 256000000"),
              std::string::npos)
        << expanded.detail;
  }
}

TEST(Expand, R36_MemoryFollowsWhatHasArrived) {
  Draft draft =
      Draft::make({MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary}, 8192, 16384);
  std::fill(draft.elements().begin(), draft.elements().end(), std::byte{0});
  const auto bomb = must(compress(std::move(draft).finish(), Encoding::Zstd));
  EXPECT_LT(bomb.elements.size(), 16000U) << "it would become 128 MiB";
  EXPECT_EQ(refused(expand(bomb)).code, Code::TooLarge);
}

TEST(Expand, R36_R37_TheFlattestImagesComeBack) {
  Draft draft =
      Draft::make({MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary}, 8000, 8000);
  std::fill(draft.elements().begin(), draft.elements().end(), std::byte{128});
  Message flat = std::move(draft).finish();
  for (Encoding encoding : {Encoding::Zstd, Encoding::Jpeg}) {
    auto small = must(compress(flat, encoding));
    auto again = must(expand(small));
    EXPECT_TRUE(std::equal(again.elements.begin(), again.elements.end(), flat.elements.begin()));
  }
}

TEST(Expand, R36_R37_AnotherSizeIsRefused) {
  for (Encoding encoding : {Encoding::Zstd, Encoding::Jpeg}) {
    for (std::int32_t by : {-1, 1}) {
      auto packed = compress(gradient(1), encoding);
      packed->header.width += by;
      EXPECT_EQ(refused(expand(*packed)).code, Code::Malformed);
    }
  }
}

}  // namespace
}  // namespace hc
