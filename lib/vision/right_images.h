// SPDX-License-Identifier: Apache-2.0
#pragma once
// Right images that wait for the left ones of their times. Pure.

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

#include <hc/base/time.h>
#include <hc/mtp/message.h>

namespace hc::vision {

/// Keeps right images until their left ones, which wait for the pose of the head, are looked at.
class RightImages {
 public:
  static constexpr std::size_t kMost = 4;

  void add(Message image) {
    images_.push_back(std::move(image));
    if (images_.size() > kMost) images_.pop_front();
  }
  /// The image of a time; older ones are dropped. Null: it has not come. Valid until the next call.
  const Message* find(Time time) {
    std::erase_if(images_, [&](const auto& image) { return image.header.time < time; });
    const auto found =
        std::ranges::find(images_, time, [](const Message& image) { return image.header.time; });
    return found == images_.end() ? nullptr : &*found;
  }

 private:
  std::deque<Message> images_;
};

}  // namespace hc::vision
