// SPDX-License-Identifier: Apache-2.0
#include <nets/tflite.h>

#include <gtest/gtest.h>

#include <random>
#include <span>
#include <string>

#include <nets/network.h>
#include <nets/weights.h>

namespace {

using hc::nets::read_tflite;

const std::string& file() {
  static const std::string bytes =
      *hc::nets::read_weights(hc::nets::weights_path("face_detection_short_range.tflite"));
  return bytes;
}

auto read(const std::string& bytes) {
  return read_tflite(std::as_bytes(std::span(bytes)));
}

TEST(Tflite, has_layers_with_weights_of_32_bits) {
  const auto layers = read(file());
  ASSERT_TRUE(layers) << layers.error().text();
  EXPECT_EQ(layers->layers.size(), 90U);  // without those that widen weights
  const auto& first = layers->layers.front();
  EXPECT_EQ(first.kind, hc::nets::Kind::Convolution);
  EXPECT_TRUE(first.is_padded);
  EXPECT_EQ(first.stride_down, 2);
  const auto& weights = layers->tensors[static_cast<std::size_t>(first.inputs[1])];
  EXPECT_EQ(weights.shape, (hc::nets::Shape{24, 5, 5, 3}));
  EXPECT_EQ(weights.numbers.size(), 24U * 5 * 5 * 3);
}

TEST(Tflite, a_truncated_file_is_refused) {
  for (std::size_t size = 0; size < file().size(); size += 997) {
    const auto refused = read(file().substr(0, size));
    ASSERT_FALSE(refused) << size;
    EXPECT_FALSE(refused.error().detail.empty());
  }
}

TEST(Tflite, damaged_bytes_are_refused_or_computed) {
  std::mt19937 random(7);
  constexpr int kTries = 400;
  for (int i = 0; i < kTries; ++i) {
    std::string bytes = file();
    // Most structure is in front of and behind the weights.
    const std::size_t size = i % 2 == 0 ? bytes.size() : 20'000;
    const std::size_t begin = i % 4 == 1 ? bytes.size() - size : 0;
    for (int k = 0; k < 1 + i % 5; ++k)
      bytes[begin + random() % size] = static_cast<char>(random());
    const auto layers = read(bytes);
    if (!layers) continue;
    if (auto network = hc::nets::Network::make(*layers)) {
      const auto& input = (*network)->input();
      (*network)->run(cv::Mat::zeros(input[0], input[1], CV_32FC(input[2])));
    }
  }
}

TEST(Tflite, what_is_another_file_is_said) {
  EXPECT_EQ(read(std::string(100, 'x')).error().text(),
            "Malformed: not a file of TensorFlow Lite: it does not have TFL3 at byte 4");
  EXPECT_FALSE(read(""));
}

}  // namespace
