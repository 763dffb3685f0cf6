// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores how well a robot reads aloud: texts to read, and their results. Pure: times come from the
// caller.

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/time.h>

/// Capital letters and digits, 5 to 16 of them with the space: a word of 5 to 8, or two of 3 to 8.
std::string random_text(std::mt19937_64& random);

/// Letters to insert, delete or replace to make one text of the other (Levenshtein 1966).
std::size_t edits(const std::string& truth, const std::string& read);

/// The result of a text; `read` is empty if it was not read.
struct ReadText {
  std::string truth, read;
  std::optional<double> seen_to_spoken;  ///< [s]; none if not spoken in time
  double work = 0;                       ///< the part of it after the decisive image [s]
};

struct ReadingScore {
  double error_rate = 0;        ///< edits per letter of all texts; > 1 if much was inserted
  double median = 0, most = 0;  ///< seen to spoken, of the spoken texts [s]
  double work = 0;              ///< median of their work [s]
  std::size_t texts = 0, unspoken = 0;

  /// error_rate, median, most, work, texts, unspoken.
  [[nodiscard]] std::array<double, 6> numbers() const;
  /// "character error rate 2.0 %, seen to spoken 0.50 s median, 0.90 s at most, of 20 texts".
  [[nodiscard]] std::string text() const;
};

ReadingScore score_of(const std::vector<ReadText>& texts);

/// One text, from writing until read and spoken. The first reading counts, even if wrong; readings
/// of earlier images do not.
class Attempt {
 public:
  Attempt(std::string truth, hc::Time written_at)
      : truth_(std::move(truth)), written_at_(written_at) {}

  /// @param image  time of the image read.
  void take_text(const std::string& text, hc::Time image);
  /// @param image  time of the image whose text is spoken.
  void take_sound(hc::Time image, hc::Time now);

  [[nodiscard]] bool is_done() const { return read_.has_value() && spoken_at_.has_value(); }
  [[nodiscard]] const std::string& truth() const { return truth_; }
  [[nodiscard]] hc::Time written_at() const { return written_at_; }
  [[nodiscard]] ReadText result() const;

 private:
  std::string truth_;
  hc::Time written_at_;
  std::optional<std::string> read_;
  std::optional<hc::Time> spoken_at_;
  hc::Time image_;  // of the spoken text
};

/// Writes texts one after another, each until read and spoken. Call finish(), then write(), often.
class Dictation {
 public:
  /// @param latest  when to write the first text, unless one is read before.
  Dictation(std::uint64_t seed, hc::Time latest) : random_(seed), next_at_(latest) {}

  /// As Attempt's. The first text read shows that everything runs; the dictation starts 1 s later.
  void take_text(const std::string& text, hc::Time image, hc::Time now);
  /// @param duration  of the sound [s].
  void take_sound(hc::Time image, hc::Time now, double duration);

  /// The result of the text, once it is read and spoken or has timed out.
  /// @param time_out  of a text [s].
  /// @param pause  from the end of the speech to the next text [s].
  std::optional<ReadText> finish(hc::Time now, double time_out, double pause);
  /// The next text, when it is due.
  std::optional<std::string> write(hc::Time now);

  /// Whether this many texts are finished.
  [[nodiscard]] bool is_done(std::int64_t texts) const;
  [[nodiscard]] ReadingScore score() const { return score_of(texts_); }

 private:
  std::mt19937_64 random_;
  std::vector<ReadText> texts_;  // finished
  std::optional<Attempt> attempt_;
  hc::Time next_at_, heard_until_;  // next text; end of the speech
  bool has_begun_ = false;
};
