// SPDX-License-Identifier: Apache-2.0
#pragma once
// How the images of a link follow its bandwidth, and how a link slows down while nothing changes
// (doc/links.md). Internal. Pure: time is passed in.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <hc/base/time.h>
#include <hc/link/policy.h>
#include <hc/mtp/message.h>

namespace hc::internal {

/// The form in which an image is sent.
struct Form {
  int quality = 0;   ///< of JPEG, 1 … 100
  double scale = 1;  ///< of width and height
  bool operator==(const Form&) const = default;
};

/// Chooses the form of each image so that all fit into a bandwidth: first it lowers the quality of
/// JPEG to 30, then the scale in quarters to 1/4, with a quality of 30 to 75, then the rate; and it
/// raises them again in the opposite order. Where the network turns out to be slower than the
/// bandwidth, images follow what it takes.
///
/// Links that are adapted alike share an object: images of the same time get the same answer.
class Adaptation {
 public:
  struct Limits {
    std::uint64_t bandwidth = 0;  ///< of each link [byte/s]
    Form best;                    ///< where the bandwidth allows it
    bool may_scale = true;        ///< images may be smaller
    bool may_skip = true;         ///< images may be dropped: the link does not keep all
    bool operator==(const Limits&) const = default;
  };
  explicit Adaptation(const Limits& limits)
      : limits_(limits), path_(static_cast<double>(limits.bandwidth)) {}

  /// The form of the next image; nullopt: skip it.
  /// @param is_behind  an earlier image has not been handed over completely.
  std::optional<Form> choose(Time time, TimePoint now, bool is_behind);
  /// Says how large an image was in the form that was chosen. [byte]
  void note_size(std::uint64_t bytes) { largest_ = std::max(largest_, bytes); }

  [[nodiscard]] const Limits& limits() const { return limits_; }
  /// The form of the last image that was sent.
  [[nodiscard]] Form form() const { return form_; }

 private:
  void learn_size();
  void learn_path(double elapsed, bool is_behind);
  [[nodiscard]] int stages() const;
  [[nodiscard]] double wanted_period() const;
  [[nodiscard]] Form form_now();

  Limits limits_;
  double path_;                // what the network takes, as far as known [byte/s]
  double dial_ = 0.5;          // 0: the best form; see form_now() and wanted_period()
  int stage_ = 0;              // of the scale
  double period_ = 0;          // of the images; 0: unknown [s]
  int behind_ = 0;             // images skipped since the last was not handed over completely
  double size_ = 0;            // of the last images of one time [byte]
  std::uint64_t largest_ = 0;  // of the images of one time; 0: none was sent [byte]
  Time time_;                  // of the last image
  std::optional<TimePoint> last_, due_;
  std::optional<Form> chosen_;
  Form form_ = limits_.best;
};

/// Lets messages pass at a low rate while they do not change, and all of them for a second after a
/// change. An image of u8 has changed if more than one of 1000 pixels differs by more than 12, of
/// up to 4096 that are compared: more than a camera's noise, and less than a ball that moves. All
/// other messages are compared byte by byte.
class IdleRate {
 public:
  /// @param rate  [message/s], above 0.
  explicit IdleRate(double rate)
      : period_(std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate))) {}
  /// Whether to send a message. Cost: one pass over 4096 pixels, or over the elements.
  bool lets_pass(const Message& message, TimePoint now);

 private:
  [[nodiscard]] bool changes(const Message& message);

  std::chrono::nanoseconds period_;
  Header header_;                  // of the last message that was sent
  std::vector<std::byte> sample_;  // of its elements
  std::vector<std::byte> next_;
  std::optional<TimePoint> sent_, changed_;
};

}  // namespace hc::internal
