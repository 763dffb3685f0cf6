// SPDX-License-Identifier: Apache-2.0
#pragma once
// Boards as cameras with known numbers see them, for tests.

#include <cstdint>
#include <random>
#include <vector>

#include <vision/board_pose_test.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {

/// A picture of a board on paper.
struct Print {
  cv::Mat picture;     ///< (H, W) u8
  double dot = 1;      ///< side of its pixels [m]
  cv::Point2d origin;  ///< first inner corner, from the picture's top left edge [m]
};

/// A chessboard in a white margin of a square, which begins and ends with a black square.
inline Print print_of(const Board& board, int dots = 32) {
  const cv::Size squares(board.columns + 1, board.rows + 1);
  Print print{
      cv::Mat((squares.height + 2) * dots, (squares.width + 2) * dots, CV_8U, cv::Scalar(230)),
      board.square / dots,
      {2 * board.square, 2 * board.square}};
  for (int row = 0; row < squares.height; ++row)
    for (int column = row % 2; column < squares.width; column += 2)
      print.picture(cv::Rect((column + 1) * dots, (row + 1) * dots, dots, dots)).setTo(20);
  return print;
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
