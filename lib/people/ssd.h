// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds things of one kind in images, by a small network that looks for one at each of many places
// (a single-shot detector, as MediaPipe has them for faces and palms).

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <hc/base/result.h>
#include <nets/network.h>
#include <people/box.h>

namespace hc::people {

/// What a network looks for. A detection is a struct of a `box` and an array of `points` [px], and
/// a `score` 0 … 1; see Face.
class Ssd {
 public:
  /// A grid of square cells that fill the network's image, each with so many anchors in its middle.
  struct Grid {
    int side = 1;  ///< of a cell [px]
    int anchors = 0;
  };
  struct Range {
    float black = 0, white = 1;
  };

  /// @param grids  in the order of the network's numbers. @param points  of a detection.
  /// @param range  of the numbers of an image.
  /// @param what  the network finds: "faces".
  ///
  /// Errors: Malformed (its inputs and outputs are not those of such a network).
  static Result<Ssd> make(std::unique_ptr<nets::Network> network, std::initializer_list<Grid> grids,
                          std::size_t points, Range range, std::string_view what);

  /// (width, height) of the images that the network sees. [px]
  [[nodiscard]] cv::Size size() const { return size_; }

  /// The detections in a part of an image, which may extend beyond it, unmerged, in any order. The
  /// network sees the part in the middle of a rectangle of the shape of size(). Their numbers are
  /// finite, and they are at most two of its longer sides away.
  /// @param image  (height, width) of u8, RGB or grey. @param least  of their scores.
  template <typename Detection>
  std::vector<Detection> find(const cv::Mat& image, const cv::Rect& part, float least) {
    std::vector<Detection> found;
    for (const Candidate& one : candidates(image, part, least)) {
      Detection detection;
      const cv::Point2f half(one.numbers[2] * one.scale / 2, one.numbers[3] * one.scale / 2);
      detection.box = {one.place(0) - half, one.place(0) + half};
      detection.score = one.score;
      for (std::size_t i = 0; i < detection.points.size(); ++i)
        detection.points[i] = one.place(4 + 2 * i);
      found.push_back(detection);
    }
    return found;
  }

 private:
  /// What the network says of an anchor: the centre and size of a box, and points.
  struct Candidate {
    float score = 0;
    const float* numbers = nullptr;  // [px] of the network's image, relative to the anchor
    cv::Point2f anchor;              // [px]
    float scale = 0;                 // of the network's pixels [px]
    [[nodiscard]] cv::Point2f place(std::size_t number) const {
      return anchor + cv::Point2f(numbers[number], numbers[number + 1]) * scale;
    }
  };

  Ssd(std::unique_ptr<nets::Network> network, std::vector<cv::Point2f> anchors, Range range)
      : network_(std::move(network)),
        size_(network_->input()[1], network_->input()[0]),
        anchors_(std::move(anchors)),
        range_(range) {}
  /// Valid until the next call.
  std::vector<Candidate> candidates(const cv::Mat& image, const cv::Rect& part, float least);

  std::unique_ptr<nets::Network> network_;
  cv::Size size_;
  std::vector<cv::Point2f> anchors_;  // in the network's image [px]
  Range range_;
  std::vector<cv::Mat> outputs_;  // of the last image
};

/// Keeps one box of those that overlap by more than `most`: their mean, weighted by their scores.
/// Best first.
/// Source: MediaPipe, non_max_suppression_calculator, WEIGHTED.
template <typename Detection>
std::vector<Detection> merged(std::vector<Detection> found, float most = 0.3F) {
  std::sort(found.begin(), found.end(),
            [](const Detection& a, const Detection& b) { return a.score > b.score; });
  std::vector<Detection> kept;
  while (!found.empty()) {
    const Detection best = found.front();
    Detection sum;
    float weight = 0;
    std::vector<Detection> others;
    cv::Point2f begin, end;
    for (const Detection& one : found) {
      if (overlap(one.box, best.box) <= most) {
        others.push_back(one);
        continue;
      }
      weight += one.score;
      begin += one.box.tl() * one.score;
      end += one.box.br() * one.score;
      for (std::size_t i = 0; i < one.points.size(); ++i)
        sum.points[i] += one.points[i] * one.score;
    }
    if (others.size() == found.size()) others.erase(others.begin());  // an empty box
    if (weight > 0) {
      sum.box = {begin / weight, end / weight};
      for (auto& point : sum.points) point /= weight;
      sum.score = best.score;
      kept.push_back(sum);
    }
    found = std::move(others);
  }
  return kept;
}

}  // namespace hc::people
