// SPDX-License-Identifier: Apache-2.0
#pragma once
// Splits the output of a process into lines and keeps the last ones. Pure. Internal to graph.

#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <hc/base/visible.h>

namespace hc::internal {

class Lines {
 public:
  static constexpr std::size_t kMaxLine = 4096;  ///< longer lines are split [byte]
  static constexpr std::size_t kLast = 20;       ///< lines kept

  using Take = std::function<void(const std::string& line)>;

  /// Adds a piece of text; `take` gets each complete line that is not empty, with control
  /// characters escaped.
  void add(std::string_view piece, const Take& take) {
    while (!piece.empty()) {
      const auto end = piece.find('\n');
      const auto size = std::min({end, piece.size(), kMaxLine - begun_.size()});
      begun_ += piece.substr(0, size);
      if (size == end || begun_.size() >= kMaxLine) finish(take);
      piece.remove_prefix(size == end ? size + 1 : size);
    }
  }

  /// Ends the last line, if it is incomplete.
  void finish(const Take& take) {
    if (begun_.ends_with('\r')) begun_.pop_back();
    if (begun_.empty()) return;
    take(visible(std::exchange(begun_, {})));
  }

  void keep(const std::string& line) {
    if (last_.size() == kLast) last_.pop_front();
    last_.push_back(line);
  }

  /// The kept lines, oldest first.
  [[nodiscard]] const std::deque<std::string>& last() const { return last_; }
  void forget() { last_.clear(); }

 private:
  std::string begun_;
  std::deque<std::string> last_;
};

}  // namespace hc::internal
