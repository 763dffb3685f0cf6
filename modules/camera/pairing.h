// SPDX-License-Identifier: Apache-2.0
#pragma once
// Brings together the images of two cameras that run freely, by their times. Pure.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include <opencv2/core.hpp>

/// An image, (H, W, 3) u8 blue, green, red, and when it was taken [ns since the Unix epoch].
struct Frame {
  cv::Mat image;
  std::int64_t time = 0;
};

/// A pair is given as soon as no later image can make a closer one: when its times differ by no
/// more than half a period of the camera that is behind. So nothing waits for an image to come
/// that is not needed.
class Pairing {
 public:
  /// @param side  0 left, 1 right; its times do not fall (when one does, pairing starts over).
  void add(std::size_t side, Frame frame);
  /// The next pair: left, right.
  std::optional<std::array<Frame, 2>> take();
  /// Forgets what waits on a side.
  void clear(std::size_t side) { sides_.at(side) = {}; }

 private:
  static constexpr std::size_t kMostWaiting = 8;
  struct Side {
    std::deque<Frame> waiting;
    std::deque<std::int64_t> periods;  // the last few [ns]
    std::int64_t last = 0;
    [[nodiscard]] std::optional<std::int64_t> period() const;
  };
  std::array<Side, 2> sides_;
};
