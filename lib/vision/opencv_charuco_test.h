// SPDX-License-Identifier: Apache-2.0
#pragma once
// OpenCV's ChArUco boards in its versions, for tests.

#include <vision/board.h>
#include <opencv2/aruco/charuco.hpp>

namespace hc::vision {

/// A board with markers of DICT_6X6_250.
inline cv::Ptr<cv::aruco::CharucoBoard> opencv_charuco(const Board& board) {
  const auto make = [&]<typename Made>(const auto& words, const Made*) {
    const auto square = static_cast<float>(board.square), marker = static_cast<float>(board.marker);
    // create() in OpenCV 4.6, a constructor since 4.7.
    if constexpr (requires { Made::create(3, 3, square, marker, words); })
      return Made::create(board.columns, board.rows, square, marker, words);
    else
      return cv::makePtr<Made>(cv::Size(board.columns, board.rows), square, marker, words);
  };
  const cv::aruco::CharucoBoard* kind = nullptr;
  return make(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250), kind);
}

/// The dictionary of a board; a member in OpenCV 4.6, a function since 4.7.
inline cv::Ptr<cv::aruco::Dictionary> opencv_dictionary(
    const cv::Ptr<cv::aruco::CharucoBoard>& board) {
  const auto of = [](const auto& its) {
    if constexpr (requires { its.dictionary; })
      return its.dictionary;
    else
      return cv::makePtr<cv::aruco::Dictionary>(its.getDictionary());
  };
  return of(*board);
}

/// What OpenCV draws, without a margin.
inline cv::Mat drawn_by_opencv(const Board& board, cv::Size size) {
  const auto draw = [&](auto& its) {
    cv::Mat image;
    // draw() in OpenCV 4.6, generateImage() since 4.7.
    if constexpr (requires { its.draw(size, image); })
      its.draw(size, image);
    else
      its.generateImage(size, image);
    return image;
  };
  return draw(*opencv_charuco(board));
}

}  // namespace hc::vision
