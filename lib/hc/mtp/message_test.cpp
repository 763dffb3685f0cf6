// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/message.h>

#include <gtest/gtest.h>

#include <stdexcept>

namespace hc {
namespace {

constexpr Info kRgb{MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary};

Message small_image() {
  Draft draft = Draft::make(kRgb, 3, 2);
  auto pixels = draft.view<std::uint8_t>();
  for (std::size_t i = 0; i < pixels.numbers().size(); ++i)
    pixels.numbers()[i] = static_cast<std::uint8_t>(i);
  return std::move(draft).finish();
}

TEST(Message, IsViewedWithoutACopy) {
  Message image = small_image();
  auto pixels = image.view<std::uint8_t>();
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->width(), 2U);
  EXPECT_EQ(pixels->height(), 3U);
  EXPECT_EQ(pixels->components(), 3U);
  EXPECT_FALSE(pixels->empty());
  EXPECT_EQ(static_cast<const void*>(pixels->numbers().data()), image.elements.data());
  EXPECT_EQ(pixels->at(1, 1, 2), 11);
  EXPECT_EQ(pixels->row(2)[0], 12);
}

TEST(Message, AnotherScalarIsRefused) {
  EXPECT_EQ(small_image().view<float>().error().code, Code::Unsupported);
  Message packed = small_image();
  packed.header.info.encoding = Encoding::Jpeg;
  EXPECT_FALSE(packed.view<std::uint8_t>());
}

TEST(Message, OutsideIsNotRead) {
  Message image = small_image();
  auto pixels = *image.view<std::uint8_t>();
  EXPECT_THROW(static_cast<void>(pixels.at(3, 0)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(pixels.row(3)), std::out_of_range);
}

TEST(MessageDeathTest, AnotherScalarOrANegativeSideIsABug) {
  EXPECT_DEATH(static_cast<void>(Draft::make(kRgb, 1, 1).view<float>()), "check failed");
  EXPECT_DEATH(static_cast<void>(Draft::make(kRgb, 1, -1)), "check failed.*R15");
}

TEST(Message, KeepOwnsWhatWasBorrowed) {
  Message image = small_image();
  EXPECT_EQ(image.keep().elements.data(), image.elements.data());
  Message borrowed{image.header, image.elements, nullptr, 0};
  Message kept = borrowed.keep();
  EXPECT_NE(kept.elements.data(), image.elements.data());
  EXPECT_EQ(kept.text(), image.text());
  EXPECT_NE(kept.owner, nullptr);
}

TEST(Message, MemoryIsAligned) {
  for (std::size_t size : {0U, 1U, 100U, 100000U})
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(allocate_bytes(size).get()) % 64, 0U);
}

TEST(Message, LargeMemoryBeginsWhereNoHeaderLineInAPageEnds) {
  for (std::size_t size : {65536U, 1440000U, 5000001U}) {
    auto bytes = allocate_bytes(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(bytes.get()) % 4096, 512U);
    std::memset(bytes.get(), 1, size);  // ASan reports an overrun
  }
}

}  // namespace
}  // namespace hc
