// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <hc/compress/compress.h>

#include "encoder.h"

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxName = 40, kMaxPorts = 64;
constexpr std::string_view kEnding = ".mtp";

bool is_word(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

constexpr std::size_t kBlock = 512, kMostInHead = 100;          // of an archive [byte]
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 33;  // of a file in a plain archive

std::string padding(std::uintmax_t size) {
  std::string zeros(static_cast<std::size_t>((kBlock - size % kBlock) % kBlock), '\0');
  return zeros;
}

/// A head of ustar. @param kind  '0': a file, 'x': what the next head has no room for.
std::string plain_head(const std::string& folder, const std::string& file, std::uintmax_t size,
                       char kind) {
  std::string head(kBlock, '\0');
  auto put = [&](std::size_t at, const std::string& text) {
    std::copy(text.begin(), text.end(), head.begin() + static_cast<std::ptrdiff_t>(at));
  };
  auto octal = [&](std::size_t at, std::size_t digits, std::uintmax_t number) {
    for (std::size_t i = digits; i-- > 0; number /= 8)
      head[at + i] = static_cast<char>('0' + number % 8);
  };
  put(0, file.substr(0, kMostInHead));
  octal(100, 7, 0644);
  octal(108, 7, 0);
  octal(116, 7, 0);
  octal(124, 11, size);
  octal(136, 11, 0);
  put(148, "        ");
  head[156] = kind;
  put(257, "ustar");
  put(263, "00");
  put(345, folder);
  unsigned sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  octal(148, 6, sum);
  head[154] = '\0';
  return head;
}

/// "LENGTH KEY=VALUE\n", where the length counts itself.
std::string pax_record(const std::string& key, const std::string& value) {
  const std::string rest = " " + key + "=" + value + "\n";
  std::size_t length = rest.size() + 1;
  while (std::to_string(length).size() + rest.size() != length) ++length;
  return std::to_string(length) + rest;
}

/// The head of a file FOLDER/FILE in an archive, and before it what has no room there.
std::string archive_head(const std::string& folder, const std::string& file, std::uintmax_t size) {
  if (file.size() <= kMostInHead && size < kMostBytes) return plain_head(folder, file, size, '0');
  const std::string more =
      pax_record("path", folder + "/" + file) + pax_record("size", std::to_string(size));
  return plain_head(folder, "pax", more.size(), 'x') + more + padding(more.size()) +
         plain_head(folder, file, size % kMostBytes, '0');
}

/// The size of a file that can be read to its end; nothing of anything else.
std::optional<std::uintmax_t> size_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const auto size = fs::file_size(path, error);
  if (error) return std::nullopt;
  return size;
}

/// What is in a folder; nothing where it cannot be read.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    entries.push_back(entry->path());
  return entries;
}

}  // namespace

bool is_recording_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxName &&
         std::ranges::all_of(name, hc::is_of_graph_name);
}

bool is_port_name(std::string_view text) {
  const auto dot = text.find('.');
  return dot != std::string_view::npos && is_word(text.substr(0, dot)) &&
         is_word(text.substr(dot + 1));
}

std::vector<Recorded> list_recordings(const std::string& folder) {
  std::vector<Recorded> all;
  for (const auto& entry : entries_of(folder)) {
    Recorded recorded{entry.filename().string(), 0, {}};
    if (!is_recording_name(recorded.name)) continue;
    for (const auto& file : entries_of(entry)) {
      const std::string stem = file.stem().string();
      const auto size = size_of(file);
      if (file.extension() != kEnding || !is_port_name(stem) || !size) continue;
      recorded.bytes += *size;
      recorded.streams.push_back(stem);
    }
    std::ranges::sort(recorded.streams);
    if (!recorded.streams.empty()) all.push_back(std::move(recorded));
  }
  std::ranges::sort(all, {}, &Recorded::name);
  return all;
}

hc::Result<web::Part> recorded_file(const std::string& folder, const std::string& name,
                                    const std::string& port) {
  const std::string path = folder + "/" + name + "/" + port + std::string(kEnding);
  const auto size = size_of(path);
  if (!size)
    return hc::Error{hc::Code::NotFound, "there is no recording of " + port + " in " + name};
  return web::Part{{}, path, *size};
}

hc::Result<std::vector<web::Part>> archive_of(const std::string& folder, const std::string& name) {
  const auto all = list_recordings(folder);
  const auto found = std::ranges::find(all, name, &Recorded::name);
  if (found == all.end()) return hc::Error{hc::Code::NotFound, "there is no recording " + name};
  auto bytes = [](std::string text) {
    return std::make_shared<const std::string>(std::move(text));
  };
  std::vector<web::Part> parts;
  std::string before;  // the padding of the file before
  for (const auto& stream : found->streams) {
    auto file = recorded_file(folder, name, stream);
    if (!file) continue;  // it has just been deleted
    file->bytes = bytes(before + archive_head(name, stream + std::string(kEnding), file->size));
    before = padding(file->size);
    parts.push_back(std::move(*file));
  }
  parts.push_back({bytes(before + std::string(2 * kBlock, '\0')), {}, 0});
  return parts;
}

hc::Result<std::unique_ptr<Recorder>> Recorder::begin(const hc::RunningGraph& graph,
                                                      const std::string& folder,
                                                      const std::string& name,
                                                      const std::vector<std::string>& ports,
                                                      const hc::LogSink& log) {
  using hc::Code;
  if (!is_recording_name(name))
    return hc::Error{Code::Invalid, "the name of a recording is 1 to 40 letters, digits, - and _"};
  const std::set<std::string> each(ports.begin(), ports.end());
  if (ports.empty() || ports.size() > kMaxPorts || each.size() < ports.size())
    return hc::Error{Code::Invalid, "1 to 64 different outputs are recorded, as MODULE.PORT"};
  for (const auto& port : ports)
    if (!is_port_name(port)) return hc::Error{Code::Invalid, "\"" + port + "\" is not MODULE.PORT"};
  const std::string path = folder + "/" + name;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::create_directory(path, error) && !error)
    return hc::Error{Code::Invalid, "there is a recording " + name + " already"};
  if (error) return hc::Error{Code::System, path + ": " + error.message()};
  return std::unique_ptr<Recorder>(new Recorder(graph, path, name, ports, log));
}

/// An output and its file. What has been received is written when it is destroyed.
class Recorder::Track {
 public:
  Track(const hc::RunningGraph& graph, std::string port, std::string path,
        std::atomic<std::uint64_t>& bytes, std::atomic<bool>& has_failed, hc::LogSink log)
      : port_(std::move(port)),
        path_(std::move(path)),
        bytes_(bytes),
        has_failed_(has_failed),
        log_(std::move(log)) {
    observer_.emplace(
        graph, port_,
        hc::Tap::Callbacks{.open = [this] { open(); },
                           .message = [this](const hc::Message& message) { write(message); },
                           .end =
                               [this](const std::string& why, bool is_error) {
                                 if (is_error) end(why);
                               }});
  }
  ~Track() {
    observer_.reset();
    if (!sink_) return;
    if (auto closed = sink_->close(); !closed) fail(closed.error().detail);
  }
  Track(const Track&) = delete;
  Track& operator=(const Track&) = delete;

 private:
  // On the observer's thread.
  void open() {
    auto sink = hc::open_sink({"file", path_, {}});
    if (!sink) return fail(sink.error().detail);
    sink_ = std::move(*sink);
  }
  void write(const hc::Message& message) {
    if (!sink_) return;
    // Images of u8 would fill the disk; all else is kept as it is.
    auto kept = hc::expand(message);
    if (kept && is_picture(kept->header) && kept->header.info.components != 4)
      kept = hc::compress(*kept, hc::Encoding::Jpeg);
    if (!kept) {  // one that is bad is left out
      if (!std::exchange(has_left_out_, true))
        log_(hc::Level::Warning,
             "recording of " + port_ + ": left out a message: " + kept.error().detail);
      return;
    }
    if (auto sent = sink_->send(*kept); !sent) return fail(sent.error().detail);
    bytes_ += kept->elements.size();
  }
  void end(const std::string& why) {
    log_(hc::Level::Error, "recording of " + port_ + " ended: " + why);
    sink_.reset();
  }
  void fail(const std::string& why) {
    end(why + "; what was written before is kept");
    has_failed_ = true;
  }

  const std::string port_, path_;
  std::atomic<std::uint64_t>& bytes_;
  std::atomic<bool>& has_failed_;
  const hc::LogSink log_;
  bool has_left_out_ = false;
  std::unique_ptr<hc::Sink> sink_;  // null: before it is open, and once it has failed
  std::optional<hc::Tap> observer_;
};

Recorder::Recorder(const hc::RunningGraph& graph, std::string path, std::string name,
                   std::vector<std::string> ports, const hc::LogSink& log)
    : path_(std::move(path)), name_(std::move(name)), ports_(std::move(ports)) {
  for (const auto& port : ports_)
    tracks_.push_back(std::make_unique<Track>(
        graph, port, path_ + "/" + port + std::string(kEnding), bytes_, has_failed_, log));
}

/// All tracks at once: each may have an image to compress, and the pages are not served meanwhile.
Recorder::~Recorder() {
  std::vector<std::thread> ends;
  for (auto& track : tracks_) ends.emplace_back([&track] { track.reset(); });
  for (auto& end : ends) end.join();
}

double Recorder::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}
