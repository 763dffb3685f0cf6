// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pairs the images of two free-running cameras by time. Pure.

#include <array>
#include <chrono>
#include <deque>
#include <optional>

#include <hc/base/time.h>
#include <opencv2/core.hpp>

/// An image, (H, W, 3) u8 blue, green, red, and its time.
struct Frame {
  cv::Mat image;
  hc::Time time;
};

/// Returns a pair as soon as no later image can be closer: when the times differ by at most half a
/// period of the camera behind. So a pair never waits for an image it does not need.
class Pairing {
 public:
  /// @param side  0 left, 1 right; pairing restarts if its times go back.
  void add(std::size_t side, Frame frame);
  /// The next pair: left, right.
  std::optional<std::array<Frame, 2>> take();
  /// Forgets the images of a side.
  void clear(std::size_t side) { sides_.at(side) = {}; }
  /// If there has been no pair for kStarving, although both sides have images: how far apart the
  /// times of their newest images are.
  [[nodiscard]] std::optional<std::chrono::nanoseconds> starves_by() const;

  static constexpr std::chrono::seconds kStarving{3};

 private:
  static constexpr std::size_t kMostWaiting = 8;
  struct Side {
    std::deque<Frame> waiting;
    std::deque<hc::Time> times;  // the last few
    std::size_t unpaired = 0;    // since the last pair
    hc::Time unpaired_since;
    [[nodiscard]] std::optional<std::chrono::nanoseconds> period() const;
    [[nodiscard]] bool starves() const;
  };
  std::array<Side, 2> sides_;
};
