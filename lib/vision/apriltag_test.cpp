// SPDX-License-Identifier: Apache-2.0
// AprilTags of Debian's visp-images-data: rendered ones whose poses are known, and a photograph.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>

#include <vision/marker_finder.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>

namespace hc::vision {
namespace {

/// The package as installed, or as unpacked by ./dev test.
std::string folder() {
  for (const std::string root : {"/usr", HC_SOURCE_DIR "/build/data/usr"})
    if (const auto path = root + "/share/visp-images-data/ViSP-images/AprilTag/";
        std::filesystem::exists(path))
      return path;
  return {};
}

struct Truth {
  cv::Matx33d R;
  cv::Vec3d t;
};

// ViSP's tag frame has y upwards and z out of the marker.
const cv::Matx33d kTurned(1, 0, 0, 0, -1, 0, 0, 0, -1);

struct Errors {
  std::vector<double> far, turned;  // share of the distance, degrees

  void add(int id, const MarkerPose& pose, const Truth& truth) {
    cv::Vec3d turn;
    cv::Rodrigues(pose.R.t() * truth.R * kTurned, turn);
    far.push_back(cv::norm(pose.t - truth.t) / cv::norm(truth.t));
    turned.push_back(cv::norm(turn) * 180 / std::numbers::pi);
    std::printf("[          ] tag %2d at %.3f m: %.2f %% off, %.2f degrees, reprojected %.2f px\n",
                id, cv::norm(truth.t), 100 * far.back(), turned.back(), pose.error);
  }
  static double median(std::vector<double> all) {
    std::sort(all.begin(), all.end());
    return all.empty() ? INFINITY : all[all.size() / 2];
  }
};

TEST(AprilTag, RenderedPosesAreKnown) {
  const auto data = folder();
  if (data.empty()) GTEST_SKIP() << "visp-images-data is not there: ./dev test unpacks it";
  const cv::Mat grey =
      cv::imread(data + "benchmark/640x480/tag36_11_640x480.png", cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(grey.empty());
  // The tags are 0.25 and 0.125 m wide with their margins; 8 of their 10 cells are the tag. The
  // camera follows ViSP, whose pixels begin half a pixel earlier.
  const Camera camera{{700, 700, 319.5, 239.5}, {}};
  Errors errors;
  const auto tags = AprilTagFinder(1).find(grey);
  for (const auto& tag : tags) {
    std::ifstream file(data + "benchmark/640x480/cMo_" + std::to_string(tag.id) + ".txt");
    Truth truth;
    for (int row = 0; row < 3; ++row)
      file >> truth.R(row, 0) >> truth.R(row, 1) >> truth.R(row, 2) >> truth.t[row];
    ASSERT_TRUE(file) << "a tag that is not there: " << tag.id;
    const auto pose = pose_of(tag, 0.8 * (tag.id < 3 ? 0.25 : 0.125), camera);
    ASSERT_TRUE(pose);
    errors.add(tag.id, *pose, truth);
  }
  EXPECT_EQ(tags.size(), 5);
  EXPECT_LE(Errors::median(errors.far), 0.02) << "of the distance";
  EXPECT_LE(Errors::median(errors.turned), 2) << "degrees";
}

// The reference is ViSP's own result on the photograph of a cube of tags.
TEST(AprilTag, APhotographAgreesWithViSP) {
  const auto data = folder();
  if (data.empty()) GTEST_SKIP() << "visp-images-data is not there: ./dev test unpacks it";
  cv::Mat grey;
  for (const char* name : {"AprilTag.pgm", "AprilTag.png"})  // in Debian 12 and 13
    if (std::filesystem::exists(data + name)) grey = cv::imread(data + name, cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(grey.empty());
  std::map<int, Truth> truths;
  std::ifstream file(data + "ground_truth_pose.txt");
  for (std::string word; file >> word;) {
    const int id = std::stoi(word.substr(word.rfind('_') + 1));
    cv::Vec3d turn;
    auto& truth = truths[id];
    file >> truth.t[0] >> truth.t[1] >> truth.t[2] >> turn[0] >> turn[1] >> turn[2];
    cv::Rodrigues(turn, truth.R);
  }
  ASSERT_EQ(truths.size(), 12);
  const Camera camera{{615.1674805, 615.1675415, 312.1889954, 243.4373779}, {}};
  Errors errors;
  for (const auto& tag : AprilTagFinder(1).find(grey)) {
    ASSERT_TRUE(truths.contains(tag.id)) << "a tag that is not there: " << tag.id;
    const auto pose = pose_of(tag, 0.053, camera);
    ASSERT_TRUE(pose);
    errors.add(tag.id, *pose, truths[tag.id]);
  }
  EXPECT_GE(errors.far.size(), 11);
  EXPECT_LE(Errors::median(errors.far), 0.02) << "of the distance";
  EXPECT_LE(Errors::median(errors.turned), 2) << "degrees";
}

}  // namespace
}  // namespace hc::vision
