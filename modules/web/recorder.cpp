// SPDX-License-Identifier: Apache-2.0
#include "recorder.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
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

/// The head of a file in an archive, 512 bytes (POSIX.1-1988, ustar).
std::string archive_head(const std::string& path, std::uintmax_t size) {
  std::string head(512, '\0');
  auto put = [&](std::size_t at, const std::string& text) {
    std::copy(text.begin(), text.end(), head.begin() + static_cast<std::ptrdiff_t>(at));
  };
  auto octal = [&](std::size_t at, std::size_t digits, std::uintmax_t number) {
    for (std::size_t i = digits; i-- > 0; number /= 8)
      head[at + i] = static_cast<char>('0' + number % 8);
  };
  put(0, path);
  octal(100, 7, 0644);
  octal(108, 7, 0);
  octal(116, 7, 0);
  octal(124, 11, size);
  octal(136, 11, 0);
  put(148, "        ");
  head[156] = '0';
  put(257, "ustar");
  put(263, "00");
  unsigned sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  octal(148, 6, sum);
  head[154] = '\0';
  return head;
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
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    Recorded recorded{entry.path().filename().string(), 0, {}};
    if (!is_recording_name(recorded.name) || !entry.is_directory(ignored)) continue;
    for (const auto& file : fs::directory_iterator(entry.path(), ignored)) {
      const std::string stem = file.path().stem().string();
      if (file.path().extension() != kEnding || !is_port_name(stem)) continue;
      const auto size = file.file_size(ignored);
      recorded.bytes += ignored ? 0 : size;
      recorded.streams.push_back(stem);
    }
    std::ranges::sort(recorded.streams);
    if (!recorded.streams.empty()) all.push_back(std::move(recorded));
  }
  std::ranges::sort(all, {}, &Recorded::name);
  return all;
}

hc::Result<std::string> write_archive(const std::string& folder, const std::string& name) {
  const auto all = list_recordings(folder);
  const auto found = std::ranges::find(all, name, &Recorded::name);
  if (found == all.end()) return hc::Error{hc::Code::NotFound, "there is no recording " + name};
  const std::string path = folder + "/." + name + ".tar";
  std::ofstream archive(path, std::ios::binary | std::ios::trunc);
  for (const auto& stream : found->streams) {
    const std::string file = name + "/" + stream + std::string(kEnding);
    const auto size = fs::file_size(folder + "/" + file);
    std::ifstream from(folder + "/" + file, std::ios::binary);
    archive << archive_head(file, size);
    // As long as it was: it may still grow.
    std::array<char, 65536> piece;
    for (std::uintmax_t left = size; left > 0 && archive;) {
      const auto part = static_cast<std::streamsize>(std::min<std::uintmax_t>(left, piece.size()));
      if (!from.read(piece.data(), part)) break;
      archive.write(piece.data(), part);
      left -= static_cast<std::uintmax_t>(part);
    }
    archive << std::string((512 - size % 512) % 512, '\0');
  }
  archive << std::string(1024, '\0');
  archive.close();
  if (!archive) return hc::Error{hc::Code::System, "cannot write " + path};
  return path;
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
        std::atomic<std::uint64_t>& bytes, hc::LogSink log)
      : port_(std::move(port)), path_(std::move(path)), bytes_(bytes), log_(std::move(log)) {
    observer_.emplace(
        graph, port_,
        web::Observer::Callbacks{.open = [this] { open(); },
                                 .message = [this](const hc::Message& message) { write(message); },
                                 .end =
                                     [this](const std::string& why, bool is_error) {
                                       if (is_error) fail(why);
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
    if (!kept) return fail(kept.error().detail);
    if (auto sent = sink_->send(*kept); !sent) return fail(sent.error().detail);
    bytes_ += kept->elements.size();
  }
  void fail(const std::string& why) {
    log_(hc::Severity::Error, "recording of " + port_ + " ended: " + why);
    sink_.reset();
  }

  const std::string port_, path_;
  std::atomic<std::uint64_t>& bytes_;
  const hc::LogSink log_;
  std::unique_ptr<hc::Sink> sink_;  // null: before it is open, and once it has failed
  std::optional<web::Observer> observer_;
};

Recorder::Recorder(const hc::RunningGraph& graph, std::string path, std::string name,
                   std::vector<std::string> ports, const hc::LogSink& log)
    : path_(std::move(path)), name_(std::move(name)), ports_(std::move(ports)) {
  for (const auto& port : ports_)
    tracks_.push_back(std::make_unique<Track>(
        graph, port, path_ + "/" + port + std::string(kEnding), bytes_, log));
}

Recorder::~Recorder() = default;

double Recorder::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}
