// SPDX-License-Identifier: Apache-2.0
#pragma once
// Text that is to be spoken: made harmless, and queued. Pure.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

/// Text as it may be given to the synthesiser: what is not UTF-8, controls (which would command
/// it), and line ends become spaces; a word longer than 60 characters is broken, and what is behind
/// `most` characters is cut off.
std::u32string speakable(std::string_view text, std::size_t most = 2000);

/// A part of it as UTF-8.
std::string utf8(std::u32string_view characters);

/// Whether there is anything but spaces in it.
bool is_blank(std::u32string_view characters);

/// A text that waits for its turn.
struct WaitingText {
  std::u32string characters;
  std::int64_t time = 0;  ///< of its message
  std::int32_t mode = 0;  ///< the same
};

/// Texts that wait: the newest are kept.
class TextQueue {
 public:
  /// @param most  how many may wait.
  /// @returns  whether the oldest had to make room.
  bool push(WaitingText text, std::size_t most);
  [[nodiscard]] bool empty() const { return texts_.empty(); }
  /// The oldest; there is one.
  WaitingText pop();

 private:
  std::deque<WaitingText> texts_;
};
