// SPDX-License-Identifier: Apache-2.0
// hc record: records ports or links to a file.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <hc/base/format.h>
#include <hc/link/wait_set.h>
#include <hc/os/program.h>
#include <mcap/link.h>
#include <mcap/recorder.h>

#include "common.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

struct RecordOptions {
  std::string file, of;
  std::vector<std::string> links;
  std::string split, keep, when;
  double last = 0;  // [s]
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
};

/// Whether a link is the file that is to be written.
bool is_file(const std::string& link, const std::string& file) {
  std::error_code missing;
  auto uri = hc::parse_uri(link);
  if (!uri || (uri->scheme != "file" && uri->scheme != "-")) return false;
  std::string path = uri->scheme == "-" ? "/proc/self/fd/0" : uri->rest;
  return std::filesystem::is_regular_file(path, missing) &&
         std::filesystem::equivalent(path, file, missing);
}

struct Link {
  std::string uri;
  std::unique_ptr<hc::Source> source;  // null once it has ended
};

/// Takes the words SOURCE FILE, or FILE alone, as `file` is empty then.
void take_words(const std::string& source, const std::string& file, RecordOptions& options) {
  options.file = file.empty() ? source : file;
  if (!file.empty()) options.links.insert(options.links.begin(), source);
  if (!options.links.empty()) return;
  if (is_running_port(options.file, options.of))
    throw Failure({hc::Code::Invalid,
                   hc::format("{} is a port of a running graph: give a FILE behind it to record "
                              "it, or ./{} for a file of that name",
                              options.file, options.file)});
  if (::isatty(STDIN_FILENO) == 1)
    throw Failure({hc::Code::Invalid,
                   hc::format("nothing to record to {}: give a source before it (a URI, a file or "
                              "MODULE.PORT of a running graph), or pipe messages in",
                              options.file)});
  options.links = {"-"};
}

/// Where messages are recorded.
class Output {
 public:
  virtual ~Output() = default;
  /// @param stream  of a recording that the link is; empty: it is none.
  virtual void write(std::size_t link, std::string_view stream, const hc::Message& message) = 0;
  virtual void poll() {}
  /// How often poll() is to be called.
  [[nodiscard]] virtual std::chrono::milliseconds period() const {
    return std::chrono::milliseconds(-1);
  }
  [[nodiscard]] virtual hc::Traffic traffic() const = 0;
  virtual void close() = 0;
};

/// A file of messages.
class MessageFile : public Output {
 public:
  explicit MessageFile(const std::string& file) : file_(file), sink_(open_file_sink(file)) {}
  void write(std::size_t, std::string_view, const hc::Message& message) override {
    if (auto sent = sink_->send(message); !sent) throw Failure(file_, sent.error());
  }
  [[nodiscard]] hc::Traffic traffic() const override { return sink_->traffic(); }
  void close() override {
    if (auto closed = sink_->close(); !closed) throw Failure(file_, closed.error());
  }

 private:
  std::string file_;
  std::unique_ptr<hc::Sink> sink_;
};

/// Set by SIGUSR1: what is kept of the last time is to be saved.
volatile std::sig_atomic_t save_asked = 0;

/// A recording in MCAP: a stream for each link, or those that a link has.
class Recording : public Output {
 public:
  explicit Recording(const RecordOptions& options) : options_(options) {
    hc::mcap::RecorderOptions recorder;
    recorder.file = options.file;
    recorder.split = value_or_fail(hc::mcap::parse_bytes(options.split), "--split");
    recorder.keep = value_or_fail(hc::mcap::parse_bytes(options.keep), "--keep");
    recorder.last = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(options.last));
    recorder_ = value_or_fail(hc::mcap::Recorder::make(recorder), options.file);
    if (recorder_->file() != options.file)
      say(hc::format("hc record: {} stays as it is; continuing in {}", options.file,
                     recorder_->file()));
    for (const auto& link : options.links) {
      // What was recorded before keeps its time.
      const auto uri = hc::parse_uri(link);
      std::error_code missing;
      is_file_.push_back(uri && uri->scheme == "file" &&
                         std::filesystem::is_regular_file(uri->rest, missing));
    }
    if (options.last == 0) return;
    std::signal(SIGUSR1, [](int) { save_asked = 1; });
    if (::isatty(STDIN_FILENO) == 1 && std::ranges::find(options.links, "-") == options.links.end())
      has_keys_ = true;
    say(hc::format("hc record: keeps the last {} s; {}SIGUSR1 to {} saves them", options.last,
                   has_keys_ ? "Enter or " : "", ::getpid()));
  }

  void write(std::size_t link, std::string_view stream, const hc::Message& message) override {
    const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count();
    auto& time = times_[link];
    time = !is_file_[link] ? now : message.header.time != 0 ? message.header.time : time;
    auto& number = streams_[{link, std::string(stream)}];
    if (!number)
      number = recorder_->add_stream(stream.empty() ? stream_of(options_.links[link]) : stream);
    check(recorder_->record(*number, message, time));
    if (options_.when != options_.links[link]) return;
    const bool is_set = message.plain() && !message.elements.empty() &&
                        hc::visit_scalar(message.header.info.scalar, [&](auto zero) {
                          return message.view<decltype(zero)>()->numbers().front() != zero;
                        });
    if (is_set && !std::exchange(was_set_, is_set)) save();
    was_set_ = is_set;
  }

  void poll() override {
    check(recorder_->poll());
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    std::array<char, 256> line{};
    const bool is_pressed =
        has_keys_ && ::poll(&keys, 1, 0) > 0 && ::read(STDIN_FILENO, line.data(), line.size()) > 0;
    if (is_pressed || std::exchange(save_asked, 0) != 0) save();
  }
  [[nodiscard]] std::chrono::milliseconds period() const override {
    constexpr std::chrono::milliseconds kPeriod{200};
    return kPeriod;
  }
  [[nodiscard]] hc::Traffic traffic() const override {
    hc::Traffic traffic;
    traffic.messages = recorder_->messages();
    traffic.bytes = recorder_->bytes();
    return traffic;
  }
  void close() override { check(recorder_->close()); }

 private:
  /// MODULE.PORT as it is, a file by its name without folder and ending.
  static std::string stream_of(const std::string& link) {
    const auto uri = hc::parse_uri(link);
    if (!uri || uri->scheme == "-") return "messages";
    if (const auto stream = uri->option("stream", ""); !stream.empty()) return std::string(stream);
    if (uri->scheme != "file") return uri->rest;
    const auto name = std::filesystem::path(uri->rest).filename();
    return name.extension() == ".mtp" || name.extension() == ".mcap" ? name.stem().string()
                                                                     : name.string();
  }
  void check(const hc::Status& status) {
    if (status) return;
    static_cast<void>(recorder_->close());
    throw Failure(options_.file, {status.error().code,
                                  status.error().detail + "; what was recorded before is whole"});
  }
  void save() { say("hc record: saved " + value_or_fail(recorder_->save(), options_.file)); }

  const RecordOptions& options_;
  std::unique_ptr<hc::mcap::Recorder> recorder_;
  std::vector<bool> is_file_;
  std::map<std::size_t, std::int64_t> times_;  // of the last message of a link
  std::map<std::pair<std::size_t, std::string>, std::optional<std::size_t>> streams_;
  bool has_keys_ = false, was_set_ = false;
};

std::unique_ptr<Output> open_output(const RecordOptions& options) {
  if (hc::mcap::recording_uri(options.file)) return std::make_unique<Recording>(options);
  if (!options.split.empty() || !options.keep.empty() || options.last != 0)
    throw Failure({hc::Code::Invalid, "--split, --keep and --last are for recordings in MCAP: " +
                                          options.file + " does not end in .mcap"});
  return std::make_unique<MessageFile>(options.file);
}

void run(const RecordOptions& options) {
  std::vector<Link> links;
  for (const auto& uri : options.links) {
    if (is_file(uri, options.file))
      throw Failure(hc::Error{hc::Code::Invalid, uri + " is the file that is written"});
    links.push_back({uri, open_named(uri, options.of, options.limit)});
  }
  const auto output = open_output(options);
  Progress progress("hc record " + options.file);
  hc::Message message;
  hc::WaitSet waits(hc::stop_descriptor());
  while (!hc::stop_requested()) {  // what has arrived is kept
    bool any = false;
    std::vector<hc::Source*> open;
    for (std::size_t number = 0; number < links.size(); ++number) {
      auto& [uri, source] = links[number];
      if (source == nullptr) continue;
      auto got = value_or_fail(source->take(message), uri);
      if (got == hc::Got::End) {
        say_losses("hc record", uri, source->traffic());
        source.reset();
      } else {
        open.push_back(source.get());
      }
      if (got != hc::Got::Message) continue;
      any = true;
      output->write(number, hc::mcap::stream_of(*source), message);
      const auto traffic = output->traffic();
      progress.show(-1, hc::format("{} messages, {}", traffic.messages,
                                   bytes_in_words(static_cast<double>(traffic.bytes))));
      if (traffic.messages == options.count) return output->close();
    }
    if (open.empty()) return output->close();
    output->poll();
    if (!any) static_cast<void>(waits.wait(open, output->period()));
  }
  output->close();
  for (const auto& [uri, source] : links)
    if (source != nullptr) say_losses("hc record", uri, source->traffic());
}

}  // namespace

void add_record(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  auto* verb = app.add_subcommand("record", "Record ports or links to a file");
  auto words = std::make_shared<std::array<std::string, 2>>();
  verb->add_option("source", words->front(),
                   "what is recorded, as --in has it; where no word follows, the output file")
      ->required();
  verb->add_option("file", words->back(),
                   "output file; one that has contents stays, and FILE_2 is written");
  verb->add_option("--in", options->links,
                   "URIs, files or MODULE.PORT of a running graph; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--split", options->split,
                   "of .mcap: begin a new file after so many bytes (1G)");
  verb->add_option("--keep", options->keep,
                   "of .mcap: remove the oldest of these files beyond so many bytes (10G)");
  verb->add_option("--last", options->last,
                   "of .mcap: keep the last seconds in memory; Enter or SIGUSR1 saves them [s]")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1.0}}));
  verb->add_option("--when", options->when,
                   "of --in: save them when its first number becomes other than 0");
  add_of(*verb, options->of);
  add_count(*verb, options->count);
  add_limit(*verb, options->limit);
  verb->callback([options, words] {
    take_words(words->front(), words->back(), *options);
    run(*options);
  });
}

}  // namespace tool
