// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides which readings of a text to announce, and when. Pure: times come from the caller.

#include <cstdint>
#include <deque>
#include <string>

#include <hc/base/time.h>

class Announcer {
 public:
  struct Rules {
    double confidence = 0;  ///< minimum confidence of a reading that counts, 0 … 1
    /// Readings that must agree among the last 2 · repeat − 1; three times as many if the text
    /// nearly equals the last announced one.
    std::int64_t repeat = 1;
    double again = 0;  ///< an unchanged text is announced again after this time [s], 0: never
  };

  /// Takes a reading.
  ///
  /// @param time  when the image was taken.
  /// @param is_heard  whether an announcement has an effect now: this mode has the focus.
  /// @returns  whether to announce the text now: it is certain, and it is new, or the last
  ///     announcement was `again` ago or not heard.
  bool take(const std::string& text, double confidence, hc::Time time, const Rules& rules,
            bool is_heard = true);

  /// "read 3 texts, the last "STOP""; empty if none was announced.
  [[nodiscard]] std::string summary() const;

 private:
  std::deque<std::string> readings_;  // recent; "" if not confident
  std::string said_;                  // last announced text
  hc::Time said_at_;
  bool was_heard_ = false;
  int texts_ = 0;  // announced
};
