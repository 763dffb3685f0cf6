// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides which of many readings of a text is said, and when. Pure: times come from the caller.

#include <cstdint>
#include <deque>
#include <string>

class Announcer {
 public:
  struct Rules {
    double confidence = 0;    ///< minimum confidence of a reading that counts, 0 … 1
    std::int64_t repeat = 1;  ///< so many of the last 2 · repeat − 1 readings, the majority of
                              ///< them, are to be the same; of a text that is said already but
                              ///< for a letter or two, thrice as many
    double again = 0;         ///< after this time an unchanged text is said again, 0: never [s]
  };

  /// Takes a reading.
  ///
  /// @param time  when the image was taken [ns].
  /// @param is_heard  whether what is said now is used: not while another mode has the focus.
  /// @returns  whether its text is to be said now: it is certain, and differs from the last one, or
  ///     that was said long ago, or not heard.
  bool take(const std::string& text, double confidence, std::int64_t time, const Rules& rules,
            bool is_heard = true);

  /// "read 3 texts, the last "STOP""; empty while nothing was said.
  [[nodiscard]] std::string summary() const;

 private:
  std::deque<std::string> readings_;  // the last ones; "" unsure
  std::string said_;                  // last, and when, and whether it was heard
  std::int64_t said_at_ = 0;
  bool was_heard_ = false;
  int texts_ = 0;  // that were said
};
