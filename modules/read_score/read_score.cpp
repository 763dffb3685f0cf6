// SPDX-License-Identifier: Apache-2.0
#include "read_score.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include <hc/base/clock.h>
#include <hc/base/format.h>

namespace {

constexpr std::size_t kLeast = 5, kMost = 16;         // letters of a text
constexpr std::size_t kLeastWord = 3, kMostWord = 8;  // of a word
constexpr std::chrono::seconds kSettle{1};            // from the first reading to the first text
constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

/// Returns 0 for no values.
double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

}  // namespace

std::string random_text(std::mt19937_64& random) {
  // Not a standard distribution: those differ between libraries.
  const auto draw = [&](std::size_t least, std::size_t most) {
    return least + static_cast<std::size_t>(random() % (most - least + 1));
  };
  const std::size_t length = draw(kLeast, kMost);
  std::size_t space = length;
  if (length > kMostWord)
    space = draw(std::max(kLeastWord, length - 1 - kMostWord),
                 std::min(kMostWord, length - 1 - kLeastWord));
  std::string text;
  for (std::size_t i = 0; i < length; ++i)
    text += i == space ? ' ' : kLetters[draw(0, kLetters.size() - 1)];
  return text;
}

std::size_t edits(const std::string& truth, const std::string& read) {
  std::vector<std::size_t> row(read.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < truth.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t k = 0; k < read.size(); ++k) {
      const std::size_t replaced = diagonal + (truth[i] != read[k] ? 1 : 0);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, diagonal + 1, row[k] + 1});
    }
  }
  return row.back();
}

ReadingScore score_of(const std::vector<ReadText>& texts) {
  ReadingScore score;
  score.texts = texts.size();
  std::size_t wrong = 0, letters = 0;
  std::vector<double> times, work;
  for (const auto& text : texts) {
    wrong += edits(text.truth, text.read);
    letters += text.truth.size();
    if (text.seen_to_spoken) {
      times.push_back(*text.seen_to_spoken);
      work.push_back(text.work);
    } else {
      ++score.unspoken;
    }
  }
  if (letters > 0) score.error_rate = static_cast<double>(wrong) / static_cast<double>(letters);
  if (!times.empty()) score.most = *std::max_element(times.begin(), times.end());
  score.median = median_of(times);
  score.work = median_of(work);
  return score;
}

void Attempt::take_text(const std::string& text, hc::Time image) {
  if (image >= written_at_ && !read_) read_ = text;
}

void Attempt::take_sound(hc::Time image, hc::Time now) {
  if (image < written_at_ || spoken_at_) return;
  spoken_at_ = now;
  image_ = image;
}

ReadText Attempt::result() const {
  ReadText text{truth_, read_.value_or(""), std::nullopt};
  if (spoken_at_) {
    text.seen_to_spoken = hc::seconds(*spoken_at_ - written_at_);
    text.work = hc::seconds(*spoken_at_ - image_);
  }
  return text;
}

std::array<double, 6> ReadingScore::numbers() const {
  return {
      error_rate, median, most, work, static_cast<double>(texts), static_cast<double>(unspoken)};
}

std::string ReadingScore::text() const {
  auto line = hc::format(
      "character error rate {:.1f} %, seen to spoken {:.2f} s median, {:.2f} s at most, of {} "
      "texts",
      100 * error_rate, median, most, texts);
  if (unspoken > 0) line += hc::format("; {} not spoken in time", unspoken);
  return line;
}

void Dictation::take_text(const std::string& text, hc::Time image, hc::Time now) {
  // Let the head turn to the text it has read.
  if (!std::exchange(has_begun_, true)) next_at_ = now + kSettle;
  if (attempt_) attempt_->take_text(text, image);
}

void Dictation::take_sound(hc::Time image, hc::Time now, double duration) {
  heard_until_ = now + hc::duration(duration);
  if (attempt_) attempt_->take_sound(image, now);
}

std::optional<ReadText> Dictation::finish(hc::Time now, double time_out, double pause) {
  if (!attempt_) return std::nullopt;
  const bool is_late = now - attempt_->written_at() >= hc::duration(time_out);
  if (!attempt_->is_done() && !is_late) return std::nullopt;
  texts_.push_back(attempt_->result());
  attempt_.reset();
  next_at_ = std::max(now, heard_until_) + hc::duration(pause);
  return texts_.back();
}

std::optional<std::string> Dictation::write(hc::Time now) {
  if (attempt_ || now < std::max(next_at_, heard_until_)) return std::nullopt;
  has_begun_ = true;
  attempt_.emplace(random_text(random_), now);
  return attempt_->truth();
}

bool Dictation::is_done(std::int64_t texts) const {
  return !attempt_ && std::ssize(texts_) >= texts;
}
