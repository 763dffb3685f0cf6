// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sanitises and queues text to speak. Pure.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include <hc/base/time.h>

/// Text that is safe for the synthesiser: invalid UTF-8, control characters (which it would obey)
/// and line ends become spaces; words are broken after 60 characters, and the text is cut after
/// `most`.
std::u32string speakable(std::string_view text, std::size_t most = 2000);

std::string utf8(std::u32string_view characters);

bool is_blank(std::u32string_view characters);

/// A queued text.
struct WaitingText {
  std::u32string characters;
  hc::Time time;          ///< of its message
  std::int32_t mode = 0;  ///< of its message
};

/// A bounded queue of texts, which keeps the newest.
class TextQueue {
 public:
  /// @param most  maximum length.
  /// @returns  whether the oldest text was dropped.
  bool push(WaitingText text, std::size_t most);
  [[nodiscard]] bool empty() const { return texts_.empty(); }
  /// Takes the oldest text; the queue must not be empty.
  WaitingText pop();

 private:
  std::deque<WaitingText> texts_;
};
