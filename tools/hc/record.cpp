// SPDX-License-Identifier: Apache-2.0
// hc record: records ports, links and other recordings.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <map>
#include <utility>

#include <hc/base/format.h>
#include <hc/link/wait_set.h>
#include <hc/os/program.h>
#include <record/writer.h>

#include "common.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

using hc::record::Place;

struct RecordOptions {
  std::string file, of;
  std::vector<std::string> links;
  std::string split, keep, when;
  double last = 0;  // [s]
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
};

/// A live source.
struct Link {
  std::string word, name;
  bool is_port = false;                // of a running graph: one stream for any src
  std::unique_ptr<hc::Source> source;  // null once it has ended
};

/// Set by SIGUSR1: save the messages kept by --last.
volatile std::sig_atomic_t save_requested = 0;

/// Whether a source is the output file.
bool is_file(const Place& link, const std::string& file) {
  std::error_code missing;
  const auto path = link.uri.scheme == "-" ? "/proc/self/fd/0" : link.path;
  return std::filesystem::is_regular_file(path, missing) &&
         std::filesystem::equivalent(path, file, missing);
}

/// Whether a source is a recording, with its own times.
bool is_recording(const Place& place) {
  std::error_code missing;
  return place.kind == Place::Kind::Mcap || place.kind == Place::Kind::Folder ||
         (place.kind == Place::Kind::File && std::filesystem::is_regular_file(place.path, missing));
}

/// Takes the words [SOURCE …] FILE.
void take_words(const std::vector<std::string>& words, RecordOptions& options) {
  options.file = words.back();
  options.links.insert(options.links.begin(), words.begin(), words.end() - 1);
  check_output(options.file);
  if (!options.links.empty()) return;
  if (::isatty(STDIN_FILENO) == 1)
    throw Failure(hc::Code::Invalid,
                  hc::format("nothing to record to {}: give a source before it (a URI, a file or "
                             "MODULE.PORT of a running graph), or pipe messages in",
                             options.file));
  options.links = {"-"};
}

class Recording {
 public:
  explicit Recording(const RecordOptions& options) : options_(options) {
    std::vector<Place> recordings;
    for (const auto& word : options.links) {
      const auto place = value_or_fail(hc::record::place_of(word));
      if (is_file(place, options.file))
        throw Failure(hc::Code::Invalid, word + " is also the output file");
      const bool is_port = graph_of_port(word, options.of).has_value();
      if (!is_port && is_recording(place))
        recordings.push_back(place);
      else
        links_.push_back(
            {word, place.name(), is_port, open_named(word, options.of, options.limit)});
    }
    const auto place = value_or_fail(hc::record::place_of(options.file));
    if (!recordings.empty())
      reader_ = open_recording(
          recordings, options.limit,
          place.kind == Place::Kind::Mcap ? hc::record::Topics::All : hc::record::Topics::Mtp);
    if (recordings.size() == 1) read_ = recordings.front().text();
    open(place);
  }

  void run() {
    Progress progress("hc record " + options_.file);
    hc::WaitSet waits(hc::stop_descriptor());
    constexpr std::chrono::milliseconds kPeriod{200};
    while (!hc::stop_requested()) {
      bool any = copy();
      std::vector<hc::Source*> open;
      for (std::size_t i = 0; i < links_.size() && !is_enough(); ++i) {
        if (links_[i].source == nullptr) continue;
        any = take(i) || any;
        if (links_[i].source != nullptr) open.push_back(links_[i].source.get());
      }
      const auto& written = writer_->written();
      progress.show(-1,
                    hc::format("{} messages, {}", written.messages, bytes_in_words(written.bytes)));
      if (is_enough() || (reader_ == nullptr && open.empty())) break;
      save_if_asked();
      if (!any) static_cast<void>(waits.wait(open, kPeriod));
    }
    const auto& written = writer_->close();
    check(written.status);
    if (written.files.empty()) say("hc record: no messages were saved");
    for (const auto& link : links_)
      if (link.source != nullptr) say_losses("hc record", link.word, link.source->traffic());
  }

 private:
  void open(const Place& place) {
    hc::record::WriterOptions options;
    options.split = value_or_fail(hc::mcap::parse_bytes(options_.split), "--split");
    options.keep = value_or_fail(hc::mcap::parse_bytes(options_.keep), "--keep");
    options.last = hc::duration(options_.last);
    if (reader_ != nullptr && (links_.empty() || reader_->profile() != options.profile))
      options.profile = links_.empty() ? reader_->profile() : "";
    if (!options_.when.empty())
      options.when = value_or_fail(hc::record::place_of(options_.when)).name();
    options.log = [](hc::Level severity, std::string_view line) {
      say((severity == hc::Level::Error ? "hc record: error: " : "hc record: ") +
          std::string(line));
    };
    writer_ = value_or_fail(hc::record::Writer::open(place, options), options_.file);
    if (writer_->written().place != place.path)
      say(hc::format("hc record: {} stays as it is; continuing in {}", place.path,
                     writer_->written().place));
    if (reader_ != nullptr) check(writer_->copy_head(*reader_));
    if (options_.last == 0) return;
    std::signal(SIGUSR1, [](int) { save_requested = 1; });
    has_keys_ = ::isatty(STDIN_FILENO) == 1 &&
                std::ranges::find(options_.links, "-") == options_.links.end();
    say(hc::format("hc record: keeping the last {} s; {}SIGUSR1 to {} saves them", options_.last,
                   has_keys_ ? "Enter or " : "", ::getpid()));
  }

  /// Copies a message of a recording; false at the end.
  bool copy() {
    if (reader_ == nullptr || is_enough()) return false;
    auto copied = writer_->copy(*reader_);
    check(writer_->written().status);
    if (!copied) throw read_.empty() ? Failure(copied.error()) : Failure(read_, copied.error());
    if (!*copied) reader_.reset();
    return *copied;
  }

  /// Records a message that has arrived; false if there is none.
  bool take(std::size_t number) {
    auto& link = links_[number];
    hc::Message message;
    const auto got = value_or_fail(link.source->take(message), link.word);
    if (got == hc::Got::End) {
      say_losses("hc record", link.word, link.source->traffic());
      link.source.reset();
    }
    if (got != hc::Got::Message) return false;
    auto stream = writer_->stream_of(&link, link.name, link.is_port ? 0 : message.header.src);
    check(stream ? writer_->add(*stream, message) : hc::Status(stream.error()));
    return true;
  }

  void save_if_asked() {
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    std::array<char, 256> line{};
    const bool is_pressed =
        has_keys_ && ::poll(&keys, 1, 0) > 0 && ::read(STDIN_FILENO, line.data(), line.size()) > 0;
    if (is_pressed || std::exchange(save_requested, 0) != 0) writer_->save();
  }

  [[nodiscard]] bool is_enough() const {
    return options_.count > 0 && writer_->written().messages >= options_.count;
  }
  void check(const hc::Status& status) const {
    if (status) return;
    throw Failure(
        options_.file,
        {status.error().code, status.error().detail + "; the messages written before are kept"});
  }

  const RecordOptions& options_;
  std::vector<Link> links_;
  std::unique_ptr<hc::record::Reader> reader_;  // of recordings; null at their end
  std::string read_;                            // the recording, if there is only one
  std::unique_ptr<hc::record::Writer> writer_;
  bool has_keys_ = false;
};

}  // namespace

void add_record(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  auto* verb = app.add_subcommand("record", "Record ports or links to a file");
  auto words = std::make_shared<std::vector<std::string>>();
  verb->add_option("words", *words,
                   "sources, as for --in, and last the output: FILE.mcap, FOLDER/, or a file "
                   "of messages; if it has contents, FILE_2 is written instead")
      ->required();
  verb->add_option("--in", options->links,
                   "URIs, recordings or MODULE.PORT of a running graph; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--split", options->split,
                   "of .mcap: begin a new file after this many bytes (1G)");
  verb->add_option("--keep", options->keep,
                   "of .mcap: remove the oldest files above this many bytes (10G)");
  verb->add_option("--last", options->last,
                   "of .mcap: keep the last seconds in memory; Enter or SIGUSR1 saves them [s]")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1.0}}))
      ->check(number_in(0, kLongest));
  verb->add_option("--when", options->when,
                   "one of --in: save when its first number becomes non-zero");
  add_of(*verb, options->of);
  add_count(*verb, options->count);
  add_limit(*verb, options->limit);
  verb->callback([options, words] {
    take_words(*words, *options);
    Recording(*options).run();
  });
}

}  // namespace tool
