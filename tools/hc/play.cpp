// SPDX-License-Identifier: Apache-2.0
// hc play: plays a recording back at its own speed.

#include <chrono>
#include <limits>
#include <utility>

#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hc/base/text.h>
#include <hc/base/time.h>
#include <hc/os/program.h>
#include <hc/os/wait_readable.h>

#include "common.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

using MonotonicClock = std::chrono::steady_clock;

struct PlayOptions {
  std::string file, of, out = "-", speed = "1";
  bool loop = false;
  double gap = 10, from = 0, to = std::numeric_limits<double>::infinity();
  std::uint64_t limit = kDefaultLimit;
};

/// Waits for the moment at which each message is due.
class Pace {
 public:
  /// @param speed  1: as recorded; infinity: without waiting.
  /// @param gap  longer pauses are skipped. [s]
  Pace(double speed, double gap) : speed_(speed), gap_(gap) {}

  /// Waits until `seconds` of the recording have passed since the first call; false when
  /// asked to stop.
  bool wait_for(double seconds) {
    if (speed_ == std::numeric_limits<double>::infinity()) return true;
    const double pause = seconds - std::exchange(last_, seconds);
    if (!begun_ || pause > gap_) skipped_ += pause;
    if (begun_ && pause > gap_)
      say(hc::format("hc play: skipping a pause of {} (--gap)", seconds_in_words(pause)));
    begun_ = true;
    const auto due = begin_ + hc::duration((seconds - skipped_) / speed_);
    while (true) {
      auto left = due - MonotonicClock::now();
      if (left <= left.zero()) return true;
      auto wait = std::chrono::ceil<std::chrono::milliseconds>(left);
      if (!hc::wait_readable({}, hc::stop_descriptor(), wait)) return false;
    }
  }

 private:
  double speed_, gap_, last_ = 0, skipped_ = 0;
  bool begun_ = false;
  const MonotonicClock::time_point begin_ = MonotonicClock::now();
};

double parse_speed(const std::string& text) {
  if (text == "max") return std::numeric_limits<double>::infinity();
  double speed = 0;
  if (!hc::read_number(text, speed) || !(speed >= 1e-6 && speed <= 1e6))
    throw Failure(hc::Code::Invalid, "--speed is a number from 1e-6 to 1e6, or max");
  return speed;
}

/// Plays the file once; returns false if it must not be repeated: the reader has closed, there was
/// nothing to play, or it was asked to stop.
bool play_once(const PlayOptions& options, double speed, hc::Sink& sink, Progress& progress) {
  const auto place = place_of(options.file, options.of);
  auto reader = open_recording({place}, options.limit);
  std::error_code unknown;
  auto size = static_cast<double>(std::filesystem::file_size(place.path, unknown));
  hc::Time begin;
  if (place.kind != hc::record::Place::Kind::Link && options.from > 0) {
    begin = value_or_fail(reader->next_time(), options.file).value_or(hc::Time());
    reader->start_at(hc::later(begin, hc::duration(options.from)));
  }
  Pace pace(speed, options.gap);
  bool any = false;
  hc::Message message;
  while (receive(*reader, message, options.file)) {
    const auto time = reader->log_time();
    if (begin == hc::Time()) begin = time;
    if (time != hc::Time()) {  // messages before the first time are sent at once
      const double seconds = hc::seconds(time - begin);
      if (seconds < options.from) continue;
      if (seconds > options.to) break;
      if (!pace.wait_for(seconds)) return false;
    }
    if (!send(sink, message, options.out)) return false;
    any = true;
    auto traffic = reader->traffic();
    double share = size > 0 && !unknown ? static_cast<double>(traffic.bytes) / size : -1;
    progress.show(share, hc::format("{} messages", traffic.messages));
  }
  return any && !hc::stop_requested();
}

void run(const PlayOptions& options) {
  double speed = parse_speed(options.speed);
  auto sink = open_output(options.out);
  Progress progress("hc play " + options.file);
  while (play_once(options, speed, *sink, progress) && options.loop) {
  }
  auto closed = sink->close();
  say_losses("hc play", options.out, sink->traffic());
  if (!closed && closed.error().code != hc::Code::Closed)
    throw Failure(options.out, closed.error());
}

}  // namespace

void add_play(CLI::App& app) {
  auto options = std::make_shared<PlayOptions>();
  auto* verb = app.add_subcommand("play", "Play a recording back at its own speed");
  verb->add_option(
          "file", options->file,
          "a recording (FILE.mcap?stream=NAME: one stream of it), a URI, or MODULE.PORT of "
          "a running graph")
      ->required();
  add_of(*verb, options->of);
  verb->add_option("--out", options->out, "where messages go")->capture_default_str();
  verb->add_option("--speed", options->speed, "times faster than recorded, or max")
      ->capture_default_str();
  verb->add_flag("--loop", options->loop, "repeat without end");
  verb->add_option("--gap", options->gap, "longest pause to keep; longer ones are skipped [s]")
      ->capture_default_str()
      ->check(number_in(0, kLongest));
  verb->add_option("--from", options->from, "start there [s from the first message]")
      ->check(number_in(0, kLongest));
  verb->add_option("--to", options->to, "stop there [s from the first message]")
      ->check(number_in(0, kLongest));
  add_limit(*verb, options->limit);
  verb->callback([options] { run(*options); });
}

}  // namespace tool
