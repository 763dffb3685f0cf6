// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace {

TEST(ImageSequence, an_image_is_read_again_when_its_file_has_changed) {
  const std::string path = testing::TempDir() + "still_" + std::to_string(::getpid()) + ".png";
  const auto write = [&](int grey) {
    cv::imwrite(path, cv::Mat(2, 2, CV_8UC3, cv::Scalar::all(grey)));
  };
  write(10);
  auto sequence = open_sequence(path);
  const cv::Mat first = sequence->next();
  EXPECT_EQ(first.at<cv::Vec3b>(0, 0)[0], 10);
  EXPECT_TRUE(sequence->next().empty());
  sequence->rewind();
  EXPECT_EQ(sequence->next().data, first.data) << "read again for nothing";
  const auto before = std::filesystem::last_write_time(path);
  write(20);
  std::filesystem::last_write_time(path, before + std::chrono::seconds(1));
  sequence->rewind();
  EXPECT_EQ(sequence->next().at<cv::Vec3b>(0, 0)[0], 20);
  // Another file with the same name, time and size.
  const auto kept = path + ".kept";
  std::filesystem::rename(path, kept);
  write(30);
  std::filesystem::last_write_time(path, before + std::chrono::seconds(1));
  sequence->rewind();
  EXPECT_EQ(sequence->next().at<cv::Vec3b>(0, 0)[0], 30);
  std::filesystem::remove(path);
  std::filesystem::remove(kept);
}

}  // namespace
