// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a process writes, line by line, and the last lines of its log. Pure. Internal to graph.

#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <hc/base/visible.h>

namespace hc::internal {

/// Makes lines of pieces of text, and keeps the last ones.
class Lines {
 public:
  static constexpr std::size_t kMaxLine = 4096;  ///< longer ones come in parts [byte]
  static constexpr std::size_t kLast = 20;       ///< so many are kept

  using Take = std::function<void(const std::string& line)>;

  /// Takes what was read; `take` gets each line that is whole now, and none that is empty, as it is
  /// visible at a terminal.
  void add(std::string_view piece, const Take& take) {
    while (!piece.empty()) {
      const auto end = piece.find('\n');
      const auto size = std::min({end, piece.size(), kMaxLine - begun_.size()});
      begun_ += piece.substr(0, size);
      if (size == end || begun_.size() >= kMaxLine) finish(take);
      piece.remove_prefix(size == end ? size + 1 : size);
    }
  }

  /// Takes what was begun as a line: there comes no more of it.
  void finish(const Take& take) {
    if (begun_.ends_with('\r')) begun_.pop_back();
    if (begun_.empty()) return;
    take(visible(std::exchange(begun_, {})));
  }

  /// Keeps a line among the last ones.
  void keep(const std::string& line) {
    if (last_.size() == kLast) last_.pop_front();
    last_.push_back(line);
  }

  /// The last lines, the newest at the end.
  [[nodiscard]] const std::deque<std::string>& last() const { return last_; }
  void forget() { last_.clear(); }

 private:
  std::string begun_;
  std::deque<std::string> last_;
};

}  // namespace hc::internal
