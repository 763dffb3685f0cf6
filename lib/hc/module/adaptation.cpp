// SPDX-License-Identifier: Apache-2.0
#include <hc/module/adaptation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace hc::internal {
namespace {

constexpr double kUsed = 0.95;       // of the bandwidth, so that no image waits for its turn
constexpr double kLeastPath = 0.01;  // of the bandwidth
constexpr double kGrowth = 0.8;      // of the path's logarithm, while no image is behind [1/s]
constexpr double kLower = 0.3, kRaise = 0.1;  // dial for each factor of 2 in size
constexpr double kNewPeriod = 0.1;            // weight of the last period in their mean
constexpr double kPause = 1;                  // counts as a period of this length at most [s]

constexpr std::array<double, 5> kScales = {1, 0.75, 0.5, 0.375, 0.25};  // by stage
constexpr double kWorstQuality = 30, kStageQuality = 75;
// Of stages. An image at the best quality of a stage is also larger than one at the worst of the
// stage before, or images would change between two sizes.
constexpr double kHysteresis = 0.15;
constexpr double kMostThinning = 6;  // the rate falls to 1/64

}  // namespace

/// Turns the dial by the size of the last images against their share of the bandwidth.
void Adaptation::learn_size() {
  const double share = kUsed * path_ * wanted_period();
  if (largest_ == 0 || share <= 0) return;
  size_ = static_cast<double>(std::exchange(largest_, 0));
  const double excess = std::log2(size_ / share);
  dial_ =
      std::clamp(dial_ + (excess > 0 ? kLower : kRaise) * excess, 0.0, stages() + kMostThinning);
}

/// Learns what the network takes: the size of an image by the time that it took, which is known to
/// a period; else it may be more.
void Adaptation::learn_path(double elapsed, bool is_behind) {
  if (is_behind) {
    ++behind_;
    return;
  }
  const double taken = (behind_ + 0.5) * period_;
  if (std::exchange(behind_, 0) > 0)
    path_ = std::min(path_, size_ / taken);
  else
    path_ *= std::exp(kGrowth * elapsed);
  const auto most = static_cast<double>(limits_.bandwidth);
  path_ = std::clamp(path_, kLeastPath * most, most);
}

int Adaptation::stages() const {
  return limits_.may_scale ? static_cast<int>(kScales.size()) : 1;
}

/// The time between images that are sent. [s]
double Adaptation::wanted_period() const {
  return period_ * std::exp2(std::max(0.0, dial_ - stages()));
}

Form Adaptation::form_now() {
  if (dial_ > stage_ + 1 || dial_ < stage_ - kHysteresis)
    stage_ = std::min(static_cast<int>(dial_), stages() - 1);
  const double most = stage_ == 0 ? limits_.best.quality : kStageQuality;
  const double best = std::min<double>(most, limits_.best.quality);
  const double worst = std::min<double>(kWorstQuality, limits_.best.quality);
  const double part = std::clamp(dial_ - stage_, 0.0, 1.0);
  return {static_cast<int>(std::lround(best + part * (worst - best))),
          limits_.best.scale * kScales[static_cast<std::size_t>(stage_)]};
}

std::optional<Form> Adaptation::choose(Time time, TimePoint now, bool is_behind) {
  if (last_ && time == time_ && time != Time()) return chosen_;
  const double elapsed = last_ ? std::min(seconds(now - *last_), kPause) : 0;
  period_ = period_ == 0 ? elapsed : period_ + kNewPeriod * (elapsed - period_);
  learn_size();
  learn_path(elapsed, is_behind);
  time_ = time;
  last_ = now;
  const bool is_early = due_ && seconds(*due_ - now) > period_ / 2;
  chosen_.reset();
  if (limits_.may_skip && (is_behind || is_early)) return chosen_;
  due_ = std::max(due_.value_or(now) + duration(wanted_period()), now);
  chosen_ = form_ = form_now();
  return chosen_;
}

bool IdleRate::lets_pass(const Message& message, TimePoint now) {
  constexpr std::chrono::seconds kActive{1};  // after a change
  if (changes(message)) changed_ = now;
  const bool passes = now - *changed_ < kActive || now - *sent_ >= period_;
  if (!passes) return false;
  sent_ = now;
  header_ = message.header;
  sample_.swap(next_);
  return true;
}

/// Compares a message with the last that was sent; keeps what is compared in `next_`.
bool IdleRate::changes(const Message& message) {
  constexpr std::size_t kMostPixels = 4096;
  constexpr int kNoise = 12;
  const auto& header = message.header;
  const auto elements = message.elements;
  const bool is_image =
      header.info.scalar == Scalar::U8 && message.plain() &&
      (header.info.type == MatrixType::RgbImage || header.info.type == MatrixType::IntensityImage);
  const std::size_t pixel = is_image ? header.info.components : 1;
  // An odd stride, so that the pixels are not all of one column.
  const std::size_t stride = is_image ? (elements.size() / pixel / kMostPixels | 1) * pixel : 1;
  next_.clear();
  for (std::size_t at = 0; at < elements.size(); at += stride) next_.push_back(elements[at]);
  if (!sent_ || !(header_.info == header.info) || header_.width != header.width ||
      header_.height != header.height || next_.size() != sample_.size())
    return true;
  if (!is_image) return next_ != sample_;
  std::size_t differing = 0;
  for (std::size_t i = 0; i < next_.size(); ++i)
    if (std::abs(std::to_integer<int>(next_[i]) - std::to_integer<int>(sample_[i])) > kNoise)
      ++differing;
  return 1000 * differing > next_.size();
}

}  // namespace hc::internal
