// SPDX-License-Identifier: Apache-2.0
#pragma once
// How well a robot reads aloud: texts to be read, and what became of them. Pure: times come from
// the caller, in nanoseconds since the Unix epoch.

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

/// Capital letters and digits, 5 to 16 of them with the space: a word of 5 to 8, or two of 3 to 8.
std::string random_text(std::mt19937_64& random);

/// Letters to insert, delete or replace to make one text of the other (Levenshtein 1966).
std::size_t edits(const std::string& truth, const std::string& read);

/// What became of a text. What was not read is an empty `read`.
struct ReadText {
  std::string truth, read;
  std::optional<double> seen_to_spoken;  ///< [s]; not when it was not spoken in time
  double work = 0;                       ///< the part of it since the image that decided [s]
};

struct ReadingScore {
  double error_rate = 0;        ///< edits by letters of all texts; more than 1 where much was added
  double median = 0, most = 0;  ///< seen to spoken, of those that were spoken [s]
  double work = 0;              ///< median of their work [s]
  std::size_t texts = 0, unspoken = 0;
};

ReadingScore score_of(const std::vector<ReadText>& texts);

/// One text from when it is written until it was read and spoken. The first reading counts, however
/// wrong it is; readings of images from before do not.
class Attempt {
 public:
  Attempt(std::string truth, std::int64_t written_at)
      : truth_(std::move(truth)), written_at_(written_at) {}

  /// @param image  when the image was taken that was read [ns].
  void take_text(const std::string& text, std::int64_t image);
  /// @param image  the same of the text that is spoken [ns].
  void take_sound(std::int64_t image, std::int64_t now);

  [[nodiscard]] bool is_done() const { return read_.has_value() && spoken_at_.has_value(); }
  [[nodiscard]] const std::string& truth() const { return truth_; }
  [[nodiscard]] std::int64_t written_at() const { return written_at_; }
  [[nodiscard]] ReadText result() const;

 private:
  std::string truth_;
  std::int64_t written_at_;
  std::optional<std::string> read_;
  std::optional<std::int64_t> spoken_at_;
  std::int64_t image_ = 0;  // of what was spoken
};
