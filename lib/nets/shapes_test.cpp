// SPDX-License-Identifier: Apache-2.0
// Networks for images of another size. @see network_test.cpp and hostile_test.cpp for all others.
#include <nets/shapes.h>

#include <gtest/gtest.h>

#include <nets/network.h>
#include <nets/weights.h>

namespace {

using hc::Code;
using hc::nets::Network;

auto read(const std::string& name, int height, int width) {
  return Network::read(hc::nets::weights_path(name), std::array{height, width});
}

TEST(Resized, networks_of_convolutions_take_images_of_other_sizes) {
  for (const auto& [height, width] : {std::array{192, 256}, {256, 192}, {32, 320}}) {
    const auto network = read("face_detection_full_range.tflite", height, width);
    ASSERT_TRUE(network) << network.error().text();
    EXPECT_EQ((*network)->input(), (hc::nets::Shape{height, width, 3}));
    const auto outputs = (*network)->run(cv::Mat::zeros(height, width, CV_32FC3));
    ASSERT_EQ(outputs.size(), 2U);
    for (const cv::Mat& output : outputs) EXPECT_EQ(output.rows, height * width / 16);
  }
}

TEST(Resized, sizes_that_give_fractional_results_are_refused) {
  for (const auto& [height, width] :
       {std::array{192, 200}, {191, 192}, {16, 192}, {0, 192}, {-32, 192}}) {
    const auto refused = read("face_detection_full_range.tflite", height, width);
    ASSERT_FALSE(refused) << height << ' ' << width;
    EXPECT_EQ(refused.error().code, Code::Unsupported);
  }
  EXPECT_EQ(read("face_detection_full_range.tflite", 192, 200).error().detail,
            hc::nets::weights_path("face_detection_full_range.tflite") +
                ": a result of 1×12×12×128 for an image of 1×192×192×3 has no size for one of "
                "1×192×200×3");
}

TEST(Resized, networks_of_one_size_alone_are_refused) {
  EXPECT_EQ(read("hand_landmark_lite.tflite", 448, 448).error().detail,
            hc::nets::weights_path("hand_landmark_lite.tflite") +
                ": a network for images of 1×224×224×3 alone, not of 1×448×448×3");
  EXPECT_EQ(read("hand_landmark_lite.tflite", 448, 448).error().code, Code::Unsupported);
  EXPECT_EQ(read("face_recognition.json", 300, 300).error().code, Code::Unsupported);
}

TEST(Resized, too_large_ones_are_refused) {
  for (const int side : {1 << 13, 1 << 16, 1 << 30})
    EXPECT_EQ(read("face_detection_full_range.tflite", side, side).error().code, Code::TooLarge);
}

}  // namespace
