// SPDX-License-Identifier: Apache-2.0
#include "speak.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <hc/base/format.h>
#include <hc/mtp/rows.h>
#include <hc/os/program.h>

namespace {

constexpr int kRate = 22050;                    // of eSpeak NG's voices [Hz]
constexpr std::chrono::milliseconds kLook{20};  // maximum gap between texts

}  // namespace

Speak::Speak(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(text_, [this](const auto& message) { take(message); });
  module.every(kLook, [this] { speak_due(); });
  module.on_end([this] {
    while (!queue_.empty() && !hc::stop_requested()) speak(queue_.pop());
  });
}

void Speak::start() {
  synthesis_.emplace(hc::value_or_end(Synthesis::start()));
  if (synthesis_->rate() != kRate)
    throw hc::ModuleError(hc::format("eSpeak NG gives {} Hz, not {}", synthesis_->rate(), kRate));
}

void Speak::take(const hc::MessageOf<hc::StringKind>& message) {
  std::string lines;
  for (const auto& row : hc::rows_of(message)) lines += row + " ";
  auto characters = speakable(lines);
  if (is_blank(characters)) return;
  if (queue_.push({std::move(characters), message.header.time, message.header.mode},
                  static_cast<std::size_t>(*parameters_.waiting)) &&
      dropped_++ == 0)
    module_.log("queue full: the oldest texts are dropped");
  speak_due();
}

void Speak::speak_due() {
  while (!queue_.empty() && (!*parameters_.paced || module_.monotonic() >= spoken_until_))
    speak(queue_.pop());
}

void Speak::speak(const WaitingText& next) {
  auto speech = synthesis_->say(next.characters, parameters_.settings());
  if (!speech) {
    if (problem_ != speech.error().detail) module_.log(problem_ = speech.error().detail);
    return;
  }
  problem_.clear();
  send(*speech, next);
}

void Speak::send(const Speech& speech, const WaitingText& text) {
  const auto time = text.time != hc::Time() ? text.time : module_.now();
  const auto frames = speech.samples.size();
  auto draft = sound_.loan(1, static_cast<std::int32_t>(frames));
  draft.header.time = time;
  draft.header.mode = text.mode;
  std::copy(speech.samples.begin(), speech.samples.end(), draft.matrix().numbers().begin());
  std::vector<std::string> rows;
  for (const auto& word : speech.words)
    rows.push_back(hc::format("{:.3f} {:.3f} {}", word.start, word.end, utf8(word.word)));
  auto table = hc::make_rows(rows);
  table.header.time = time;
  table.header.mode = text.mode;
  constexpr std::chrono::nanoseconds kSecond = std::chrono::seconds(1);
  spoken_until_ = module_.monotonic() + static_cast<std::int64_t>(frames) * kSecond / kRate;
  ++said_;
  last_ = utf8(text.characters);
  last_.erase(last_.find_last_not_of(' ') + 1);
  last_.erase(0, last_.find_first_not_of(' '));
  words_.send({std::move(table)});  // first, since sending the sound may block while it plays
  sound_.send(std::move(draft));
}

void Speak::log_result() const {
  if (said_ > 0)
    module_.log(hc::format("said {} text{}, the last \"{}\"", said_, said_ == 1 ? "" : "s", last_),
                hc::Level::Result);
  if (dropped_ > 0) module_.log(hc::format("{} texts dropped", dropped_));
}
