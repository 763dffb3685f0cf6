// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>
#include <sstream>
#include <string_view>
#include <utility>

#include <client/running.h>
#include <hc/base/format.h>

namespace {

/// A descriptor from which SIGUSR1 is read.
int open_signals() {
  sigset_t saves;
  ::sigemptyset(&saves);
  ::sigaddset(&saves, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &saves, nullptr);
  return ::signalfd(-1, &saves, SFD_NONBLOCK | SFD_CLOEXEC);
}

}  // namespace

std::vector<StreamName> stream_names(int argc, char** argv) {
  constexpr std::string_view kStreams = "--streams";
  std::string all;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    if (word == kStreams && i + 1 < argc)
      all.append(argv[++i]).append(" ");
    else if (word.starts_with(kStreams) && word.substr(kStreams.size()).starts_with('='))
      all.append(word.substr(kStreams.size() + 1)).append(" ");
  }
  std::vector<StreamName> names;
  std::istringstream words(all);
  for (std::string word; words >> word;)
    if (const auto equals = word.find('='); equals != std::string::npos)
      names.push_back({word.substr(0, equals), word.substr(equals + 1)});
  if (names.empty()) names.push_back({"in", "in"});
  return names;
}

hc::record::WriterOptions RecorderParameters::options() const {
  hc::record::WriterOptions options;
  options.append = *append;
  options.frames = *frames;
  options.split = hc::value_or_refuse(split, hc::mcap::parse_bytes(*split));
  options.keep = hc::value_or_refuse(keep, hc::mcap::parse_bytes(*keep));
  options.last = hc::duration(*last);
  options.when = *when;
  return options;
}

hc::record::Place RecorderParameters::place(const hc::record::WriterOptions& options) const {
  const bool is_folder = !folder->empty();
  if (is_folder && !file->empty()) hc::refuse("give either `file` or `folder`");
  if (is_folder && (options.split > 0 || options.keep > 0 || *last > 0 || !when->empty()))
    hc::refuse("`split`, `keep`, `last` and `when` are for `file`");
  hc::record::Place place;
  place.kind = is_folder ? hc::record::Place::Kind::Folder : hc::record::Place::Kind::Mcap;
  place.path = is_folder ? *folder : file->empty() ? "recording.mcap" : *file;
  return place;
}

StreamRecorder::StreamRecorder(hc::Module& module, const std::vector<StreamName>& streams)
    : module_(module), signals_(open_signals()), loop_(hc::value_or_end(hc::Loop::make())) {
  module.on_start([this] { start(); });
  for (std::size_t i = 0; i < streams.size(); ++i) {
    streams_.push_back(streams[i].name);
    module.on_raw(
        module.input(streams[i].input, hc::anything(), "recorded as " + streams[i].name),
        [this, i](const hc::Message& message) { fail_once(recording_->add(i, message)); });
  }
  module.on_readable([this] { return has_failed_ ? -1 : loop_->descriptor(); },
                     [this] { hc::succeed_or_end(loop_->turn(std::chrono::milliseconds(0))); });
  module.on_readable([this] { return signals_; }, [this] { save_when_signalled(); });
  module.every(std::chrono::seconds(1), [this] { look(); });
  module.on_end([this] { end(); });
}

void StreamRecorder::start() {
  auto options = parameters_.options();
  options.streams = streams_;
  options.clock = &clock_;
  options.log = [this](hc::Level severity, std::string_view line) {
    module_.log(std::string(line),
                severity == hc::Level::Error ? hc::Level::Error : hc::Level::Info);
  };
  const auto place = parameters_.place(options);
  const bool is_folder = place.kind == hc::record::Place::Kind::Folder;
  recording_ = hc::value_or_refuse(is_folder ? parameters_.folder : parameters_.file,
                                   hc::record::Writer::open(place, options));
  if (const auto& now = recording_->written().place; now != place.path)
    module_.log("recording continues in " + now, hc::Level::Notice);
  if (const auto own = hc::own_graph(); own && !is_folder)
    metadata_.emplace(graph_.emplace(*loop_, *own), *recording_);
}

void StreamRecorder::look() {
  const auto there = recording_->check_places();
  if (!there && !std::exchange(is_removed_, true))
    module_.log(there.error().detail + "; what is recorded there from now on may be lost",
                hc::Level::Error);
}

void StreamRecorder::save_when_signalled() {
  signalfd_siginfo info{};
  while (::read(signals_, &info, sizeof info) > 0)
    if (recording_ != nullptr) recording_->save();
}

void StreamRecorder::end() {
  graph_.reset();
  const auto& written = recording_->close();
  if (!is_removed_) fail_once(written.status);
  if (written.files.empty()) return module_.log("nothing saved", hc::Level::Result);
  const bool is_folder = !parameters_.folder->empty();
  const auto count = written.messages;
  std::string text = hc::format("{} message{} in {}", count, count == 1 ? "" : "s",
                                is_folder ? written.place : written.files.front());
  if (written.files.size() > 1 && !is_folder) text += hc::format(" to {}", written.files.back());
  if (written.discarded > 0) text += hc::format(", {} others not kept", written.discarded);
  if (written.lost > 0) text += hc::format(", {} not recorded", written.lost);
  module_.log(text, hc::Level::Result);
}

void StreamRecorder::fail_once(const hc::Status& status) {
  if (status || std::exchange(has_failed_, true)) return;
  module_.log(
      "recording ended: " + status.error().detail + "; the messages written before are kept",
      hc::Level::Error);
}

int StreamRecorder::finish(int status) const {
  // In a graph a failed recorder keeps running, and the graph reports the failure at its end.
  return status == 0 && (has_failed_ || is_removed_) && !hc::own_graph() ? 1 : status;
}
