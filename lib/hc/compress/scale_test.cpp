// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/scale.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include <hc/compress/compress.h>
#include <hc/mtp/matrix_view.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

template <typename T>
Message image_of(std::int32_t width, std::int32_t height, std::uint8_t components,
                 const std::vector<T>& pixels) {
  Header header;
  header.info = {components == 1 ? MatrixType::IntensityImage : MatrixType::RgbImage, components,
                 scalar_for<T>(), Encoding::Binary};
  header.width = width;
  header.height = height;
  header.time = unix_time(12);
  header.coord = 7;
  Draft draft = Draft::make(header);
  std::copy(pixels.begin(), pixels.end(), view<T>(draft).numbers().begin());
  return std::move(draft).finish();
}

template <typename T>
std::vector<T> pixels_of(const Message& image) {
  const auto numbers = view<T>(image)->numbers();
  return {numbers.begin(), numbers.end()};
}

TEST(Shrink, GivesTheMeanOfWhatAPixelCovers) {
  const auto half =
      must(shrink(image_of<std::uint8_t>(4, 2, 1, {0, 10, 20, 30, 2, 12, 255, 33}), 2, 1));
  EXPECT_EQ(pixels_of<std::uint8_t>(half), (std::vector<std::uint8_t>{6, 85}));  // 24 / 4, 338 / 4
}

TEST(Shrink, TakesWhatIsAtAnEdgeInProportion) {
  const auto smaller = must(shrink(image_of<std::uint16_t>(3, 1, 1, {0, 300, 60000}), 2, 1));
  EXPECT_EQ(pixels_of<std::uint16_t>(smaller), (std::vector<std::uint16_t>{100, 40100}));
}

TEST(Shrink, KeepsComponentsApartAndTheRestOfTheHeader) {
  const auto image = image_of<std::uint8_t>(2, 2, 3, {0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14});
  const auto one = must(shrink(image, 1, 1));
  EXPECT_EQ(pixels_of<std::uint8_t>(one), (std::vector<std::uint8_t>{6, 7, 8}));
  Header wanted = image.header;
  wanted.width = wanted.height = 1;
  EXPECT_EQ(one.header, wanted);
}

TEST(Shrink, LeavesWhiteWhiteAndTheMeanWhereItIs) {
  std::vector<std::uint8_t> pixels(97 * 61, 255);
  EXPECT_EQ(pixels_of<std::uint8_t>(*shrink(image_of(97, 61, 1, pixels), 13, 7)),
            std::vector<std::uint8_t>(13 * 7, 255));
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i * 37);
  const auto small = pixels_of<std::uint8_t>(*shrink(image_of(97, 61, 1, pixels), 13, 7));
  auto mean = [](const auto& all) {
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
  };
  EXPECT_NEAR(mean(small), mean(pixels), 0.5);  // [grey level], for rounding
}

TEST(Shrink, ExpandsWhatIsCompressed) {
  const auto image = image_of<std::uint8_t>(2, 1, 1, {10, 20});
  const auto packed = must(compress(image, Encoding::Zstd));
  EXPECT_EQ(pixels_of<std::uint8_t>(*shrink(packed, 1, 1)), std::vector<std::uint8_t>{15});
}

}  // namespace
}  // namespace hc
