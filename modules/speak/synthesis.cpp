// SPDX-License-Identifier: Apache-2.0
#include "synthesis.h"

#include <espeak-ng/speak_lib.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "words.h"

using hc::Code;
using hc::Error;
using hc::Result;

namespace {

constexpr std::size_t kLongest = 600;  // [s]

/// Collected while a text is synthesised.
struct Gathered {
  Speech speech;
  std::vector<std::size_t> begins;  // positions of the words in the text
  std::u32string_view text;
  std::size_t most = 0;
  double last = 0;  // time of the last event [s]
};

void take(Gathered& gathered, const espeak_EVENT& event) {
  // Where it speaks fast, eSpeak NG reports some words a few ms before the end of the last one.
  const double time = std::max(gathered.last, event.audio_position * 1e-3);
  if (event.type == espeakEVENT_WORD || event.type == espeakEVENT_END) {
    auto& words = gathered.speech.words;
    if (!words.empty() && words.back().end <= words.back().start) words.back().end = time;
    gathered.last = time;
  }
  if (event.type != espeakEVENT_WORD || event.text_position < 1 || event.length < 1) return;
  const auto begin = static_cast<std::size_t>(event.text_position) - 1;
  if (begin >= gathered.text.size()) return;
  if (!gathered.begins.empty()) {
    // Each part of "3.50" or "12345" is an event within the same word.
    auto& last = gathered.speech.words.back();
    if (begin >= gathered.begins.back() && begin < gathered.begins.back() + last.word.size()) {
      last.end = last.start;  // the next event sets it
      return;
    }
  }
  SpokenWord word;
  word.start = word.end = time;
  word.word = gathered.text.substr(begin, static_cast<std::size_t>(event.length));
  gathered.speech.words.push_back(std::move(word));
  gathered.begins.push_back(begin);
}

bool is_punctuation(char32_t c) {
  return c < 0x80 ? std::isalnum(static_cast<int>(c)) == 0 : c < 0xC0;
}

std::u32string_view without_punctuation(std::u32string_view word) {
  while (!word.empty() && is_punctuation(word.front())) word.remove_prefix(1);
  while (!word.empty() && is_punctuation(word.back())) word.remove_suffix(1);
  return word;
}

/// The words of a text between spaces, without the punctuation around them.
std::vector<std::u32string_view> words_in(std::u32string_view text) {
  std::vector<std::u32string_view> words;
  while (!text.empty()) {
    const auto word = text.substr(0, text.find(U' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (const auto plain = without_punctuation(word); !plain.empty()) words.push_back(plain);
  }
  return words;
}

/// eSpeak NG reports some neighbouring words as one ("There are", "on the"). Splits them, in
/// proportion to their letters.
std::vector<SpokenWord> split_joined(std::u32string_view text, const std::vector<SpokenWord>& words,
                                     const std::vector<std::size_t>& begins) {
  std::vector<SpokenWord> all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto end = begins[i] + words[i].word.size();
    const auto next = i + 1 < words.size() ? std::max(end, begins[i + 1]) : text.size();
    const auto before = i == 0 ? words_in(text.substr(0, begins[0])) : words_in({});
    // Text that follows without a space belongs to the same word.
    const auto space = std::min(next, text.find(U' ', end));
    const auto after = words_in(text.substr(space, next - space));
    const auto word = without_punctuation(text.substr(begins[i], space - begins[i]));
    std::vector<std::u32string_view> group = before;
    group.push_back(word.empty() ? words[i].word : word);
    group.insert(group.end(), after.begin(), after.end());
    std::size_t letters = 0, done = 0;
    for (const auto& word : group) letters += word.size();
    const double span = (words[i].end - words[i].start) / static_cast<double>(letters);
    for (const auto& word : group) {
      const double start = words[i].start + span * static_cast<double>(done);
      done += word.size();
      all.push_back(
          {start, words[i].start + span * static_cast<double>(done), std::u32string(word)});
    }
  }
  return all;
}

extern "C" int gather(short* samples, int count, espeak_EVENT* events) {
  Gathered* gathered = nullptr;
  for (const espeak_EVENT* event = events; event->type != espeakEVENT_LIST_TERMINATED; ++event) {
    gathered = static_cast<Gathered*>(event->user_data);
    if (gathered != nullptr) take(*gathered, *event);
  }
  if (gathered == nullptr) gathered = static_cast<Gathered*>(events->user_data);
  if (samples == nullptr || gathered == nullptr) return 0;
  auto& all = gathered->speech.samples;
  all.insert(all.end(), samples, samples + count);
  return all.size() > gathered->most ? 1 : 0;
}

}  // namespace

Result<Synthesis> Synthesis::start() {
  // Once, and never terminated: espeak_Terminate() can hang on a thread that missed its signal.
  static const int rate =
      espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 0, nullptr, espeakINITIALIZE_DONT_EXIT);
  if (rate <= 0) return Error{Code::System, "eSpeak NG cannot start; is its data installed?"};
  espeak_SetSynthCallback(gather);
  return Synthesis(rate);
}

Result<Speech> Synthesis::say(std::u32string_view text, const Voice& voice) {
  static std::optional<std::string> current;
  if (voice.name != current) {
    // eSpeak NG would open a file of that name.
    const bool is_name = !voice.name.empty() && voice.name.find('/') == std::string::npos &&
                         voice.name.find('.') == std::string::npos && voice.name.size() < 40;
    if (!is_name || espeak_SetVoiceByName(voice.name.c_str()) != EE_OK)
      return Error{Code::NotFound, "no voice \"" + voice.name + "\""};
    current = voice.name;
  }
  espeak_SetParameter(espeakRATE, std::clamp(voice.rate, espeakRATE_MINIMUM, espeakRATE_MAXIMUM),
                      0);
  espeak_SetParameter(espeakPITCH, std::clamp(voice.pitch, 0, 100), 0);
  espeak_SetParameter(espeakVOLUME, std::clamp(voice.volume, 0, 200), 0);
  Gathered gathered;
  gathered.text = text;
  gathered.most = kLongest * static_cast<std::size_t>(rate_);
  const std::string bytes = utf8(text);
  const auto status = espeak_Synth(bytes.c_str(), bytes.size() + 1, 0, POS_CHARACTER, 0,
                                   espeakCHARS_UTF8 | espeakENDPAUSE, nullptr, &gathered);
  if (status != EE_OK)
    return Error{Code::System, "eSpeak NG: error " + std::to_string(static_cast<int>(status))};
  auto& words = gathered.speech.words;
  const double length = static_cast<double>(gathered.speech.samples.size()) / rate_;
  if (!words.empty() && words.back().end <= words.back().start) words.back().end = length;
  words = split_joined(text, words, gathered.begins);
  return std::move(gathered.speech);
}
