// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <hc/module/module.h>

namespace {

TEST(ImageSequence, an_image_is_read_again_when_its_file_has_changed) {
  const std::string path = testing::TempDir() + "still_" + std::to_string(::getpid()) + ".png";
  const auto write = [&](int grey) {
    cv::imwrite(path, cv::Mat(2, 2, CV_8UC3, cv::Scalar::all(grey)));
  };
  write(10);
  auto sequence = open_sequence(path, {});
  const cv::Mat first = sequence->next().image;
  EXPECT_EQ(first.at<cv::Vec3b>(0, 0)[0], 10);
  EXPECT_TRUE(sequence->next().image.empty());
  sequence->rewind();
  EXPECT_EQ(sequence->next().image.data, first.data) << "read again for nothing";
  const auto before = std::filesystem::last_write_time(path);
  write(20);
  std::filesystem::last_write_time(path, before + std::chrono::seconds(1));
  sequence->rewind();
  EXPECT_EQ(sequence->next().image.at<cv::Vec3b>(0, 0)[0], 20);
  // Another file with the same name, time and size.
  const auto kept = path + ".kept";
  std::filesystem::rename(path, kept);
  write(30);
  std::filesystem::last_write_time(path, before + std::chrono::seconds(1));
  sequence->rewind();
  EXPECT_EQ(sequence->next().image.at<cv::Vec3b>(0, 0)[0], 30);
  std::filesystem::remove(path);
  std::filesystem::remove(kept);
}

TEST(ImageSequence, a_file_that_is_being_replaced_stays_as_it_was) {
  const std::string path = testing::TempDir() + "replaced_" + std::to_string(::getpid()) + ".jpg";
  const auto write = [&](int grey, double share) {
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", cv::Mat(64, 64, CV_8UC3, cv::Scalar::all(grey)), bytes);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(share * static_cast<double>(bytes.size())));
  };
  write(10, 1);
  auto sequence = open_sequence(path, {});
  const auto next = [&] {
    sequence->rewind();
    return sequence->next().image.at<cv::Vec3b>(63, 63)[0];
  };
  EXPECT_EQ(next(), 10);
  write(200, 0.9);
  EXPECT_EQ(next(), 10);
  write(200, 1);
  EXPECT_EQ(next(), 200);
  std::filesystem::remove(path);
}

TEST(ImageSequence, no_image_is_skipped) {
  const auto folder =
      std::filesystem::path(testing::TempDir()) / ("n_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  cv::imwrite((folder / "1.png").string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar::all(9)));
  std::ofstream(folder / "notes.txt") << "not an image";
  std::ofstream(folder / ".2.png") << "hidden, as of a file manager";
  const auto refusal = [](const std::string& name) -> std::string {
    try {
      const auto sequence = open_sequence(name, {});
      while (!sequence->next().image.empty()) continue;
    } catch (const hc::ModuleError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(folder), "");
  const std::string empty = folder / "2.jpg", away = folder / "3.png";
  { const std::ofstream file(empty); }
  for (const auto& name : {std::string(folder), empty})
    EXPECT_NE(refusal(name).find(empty + ": not a readable image"), std::string::npos) << name;
  std::filesystem::remove(empty);
  std::filesystem::create_symlink("nosuch.png", away);
  EXPECT_NE(refusal(folder).find(away + ": not a readable image"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
