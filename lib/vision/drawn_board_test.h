// SPDX-License-Identifier: Apache-2.0
#pragma once
// Boards as cameras with known numbers see them, for tests.

#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <vision/board_pose_test.h>
#include <vision/board_print.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {

/// A picture of a board on paper.
struct Print {
  cv::Mat picture;     ///< (H, W) u8
  double dot = 1;      ///< side of its pixels [m]
  cv::Point2d origin;  ///< of Board::corners(), from the picture's top left edge [m]
};

/// @param dictionary  of a ChArUco board.
inline Print printed(const Board& board, const std::string& dictionary = "") {
  const auto print = print_of(board, dictionary);
  if (!print) throw std::runtime_error(print.error().detail);
  const double dot = board.kind == BoardKind::AprilGrid ? board.marker / 80 : board.square / 64;
  return {image_of(*print, dot, 20, 230), dot, print->origin};
}

/// A camera that draws what it sees.
class DrawingCamera {
 public:
  DrawingCamera(const cv::Matx33d& M, const std::vector<double>& D, cv::Size size) : size_(size) {
    std::vector<cv::Point2f> pixels;
    for (int y = 0; y < size.height * kFine; ++y)
      for (int x = 0; x < size.width * kFine; ++x)
        pixels.emplace_back((static_cast<float>(x) + 0.5F) / kFine - 0.5F,
                            (static_cast<float>(y) + 0.5F) / kFine - 0.5F);
    cv::undistortPoints(pixels, rays_, M, D);
  }

  /// @param noise  standard deviation [grey levels]; the lens blurs by `blur` pixels.
  [[nodiscard]] cv::Mat draw(const Print& print, const BoardPose& pose, double noise = 2,
                             double blur = 0.7, std::uint64_t seed = 1) const {
    const cv::Matx33d H = cv::Matx33d(pose.R(0, 0), pose.R(0, 1), pose.t[0],  //
                                      pose.R(1, 0), pose.R(1, 1), pose.t[1],  //
                                      pose.R(2, 0), pose.R(2, 1), pose.t[2])
                              .inv();
    cv::Mat fine(size_ * kFine, CV_8U);
    for (int i = 0; i < fine.rows * fine.cols; ++i) {
      const auto& ray = rays_[static_cast<std::size_t>(i)];
      const cv::Vec3d p = H * cv::Vec3d(ray.x, ray.y, 1);
      const double x = (p[0] / p[2] + print.origin.x) / print.dot;
      const double y = (p[1] / p[2] + print.origin.y) / print.dot;
      const bool is_on =
          p[2] > 0 && x >= 0 && y >= 0 && x < print.picture.cols && y < print.picture.rows;
      fine.data[i] = is_on
                         ? print.picture.at<std::uint8_t>(static_cast<int>(y), static_cast<int>(x))
                         : std::uint8_t{110};
    }
    cv::Mat image;
    cv::resize(fine, image, size_, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(image, image, {}, blur);
    cv::Mat dirt(size_, CV_16S);
    cv::RNG(seed).fill(dirt, cv::RNG::NORMAL, 0, noise);
    cv::add(image, dirt, image, {}, CV_8U);
    return image;
  }

 private:
  static constexpr int kFine = 4;  // samples along a pixel's side

  cv::Size size_;
  std::vector<cv::Point2f> rays_;
};

}  // namespace hc::vision
