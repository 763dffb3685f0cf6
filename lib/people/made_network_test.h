// SPDX-License-Identifier: Apache-2.0
#pragma once
// A network that says what a test tells it to.

#include <memory>
#include <utility>
#include <vector>

#include <nets/network.h>

namespace hc::people {

class MadeNetwork final : public nets::Network {
 public:
  /// @param outputs  of any image; the test may change their numbers.
  MadeNetwork(nets::Shape input, std::vector<cv::Mat> outputs)
      : input_(std::move(input)), outputs_(std::move(outputs)) {}

  [[nodiscard]] const nets::Shape& input() const override { return input_; }
  std::vector<cv::Mat> run(const cv::Mat& image) override {
    last_ = image.clone();
    return outputs_;
  }
  /// The last image.
  [[nodiscard]] const cv::Mat& last() const { return last_; }

 private:
  nets::Shape input_;
  std::vector<cv::Mat> outputs_;
  cv::Mat last_;
};

}  // namespace hc::people
