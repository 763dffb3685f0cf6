// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the verbs of hc share: links by their text, errors as exceptions, signals, progress.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <graph/programs.h>
#include <hc/link/link.h>
#include <record/reader.h>

namespace tool {

inline constexpr std::string_view kBold = "\x1b[1m", kNormal = "\x1b[0m";  ///< of a terminal
inline constexpr std::uint64_t kDefaultLimit = std::uint64_t{256} << 20;   ///< of elements [byte]

/// Ends a verb with one line on standard error and an exit status; quietly with 0 when it was asked
/// to stop.
struct Failure : std::runtime_error {
  explicit Failure(const hc::Error& error)
      : std::runtime_error(error.text()),
        code(error.code),
        detail(error.detail),
        status(status_of(error.code)) {}
  Failure(hc::Code what, std::string why) : Failure(hc::Error{what, std::move(why)}) {}
  Failure(std::string_view who, const hc::Error& error)
      : Failure(error.code, std::string(who) + ": " + error.detail) {}
  /// Without a line: it has been logged.
  explicit Failure(int exit_status) : std::runtime_error(""), status(exit_status) {}

  hc::Code code = hc::Code::System;
  std::string detail;
  int status;

 private:
  static int status_of(hc::Code code) {
    return code == hc::Code::Stopped ? 0 : code == hc::Code::Invalid ? 2 : 1;
  }
};

template <typename T>
T value_or_fail(hc::Result<T> result, std::string_view who) {
  if (!result) throw Failure(who, result.error());
  return std::move(*result);
}

template <typename T>
T value_or_fail(hc::Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(*result);
}

/// Limits, log and stop of a link. `limit` bounds the elements that are taken. [byte]
hc::LinkOptions link_options(std::uint64_t limit = kDefaultLimit);

/// Links and recordings as the command line names them (record/place.h). `limit` bounds the
/// elements that are taken. [byte]
std::unique_ptr<hc::Source> open_source(const std::string& uri, std::uint64_t limit);
std::unique_ptr<hc::Sink> open_sink(const std::string& uri);

std::unique_ptr<hc::record::Reader> open_recording(
    const std::vector<hc::record::Place>& places, std::uint64_t limit,
    hc::record::Topics topics = hc::record::Topics::Mtp);

/// Files of messages by their path.
std::unique_ptr<hc::Source> open_file_source(const std::string& path, std::uint64_t limit);
std::unique_ptr<hc::Sink> open_file_sink(const std::string& path);

/// Takes the next message; false at the end, or when we are asked to stop.
bool receive(hc::Source& source, hc::Message& message, const std::string& uri);

/// The same, which continues behind damaged bytes, and says so as `verb`. Everything else is
/// thrown, and so is the damage when it does not end, or `is_skipping` is not set.
bool receive(hc::Source& source, hc::Message& message, const std::string& uri,
             std::string_view verb, bool is_skipping);

/// Sends a message; false when nobody reads any more.
bool send(hc::Sink& sink, const hc::Message& message, const std::string& uri);

/// "253 throttled, 8 lost without a reader"; empty where none were.
std::string losses_in_words(const hc::Traffic& traffic);
/// Logs how many messages a link has dropped and why, if any.
void say_losses(std::string_view verb, std::string_view uri, const hc::Traffic& traffic);

/// Writes to standard output; false when nobody reads any more. Any other error is a Failure.
bool print(std::string_view text);

/// Raises the limit of open descriptors, of which each module takes several: a login shell allows
/// 1024, the system more to who asks. Not all of it: there are programs that close every number up
/// to their limit.
void allow_descriptors();

/// Of the terminal, with 80 x 24 where it is not known. [character]
struct TerminalSize {
  std::size_t width = 80, height = 24;
};
TerminalSize terminal_size();

/// One line to the person, on standard error.
void say(std::string_view line);

using hc::find_program;
using hc::module_folder;
using hc::module_names;

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view between = ", ");
/// "1 message", "2 messages"
std::string counted(std::uint64_t number, std::string_view what);

/// A graph file by its name: that file, or else one of the graphs that came with hc, with or
/// without ".toml".
std::string find_graph(const std::string& name);
/// The names of the graphs that came with hc, without ".toml".
std::vector<std::string> shipped_graphs();

/// "1.44 MB"
std::string bytes_in_words(std::uint64_t bytes);

/// "12 s", "3:05 min", "4:00 h", "12 d"
std::string seconds_in_words(double seconds);

/// A bar on standard error, where that is a terminal; silent elsewhere.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  /// @param share  0 … 1; negative where the end is not known.
  void show(double share, std::string_view words);

 private:
  std::string what_;
  bool on_terminal_;
  std::int64_t shown_ = 0;  // when, monotonic [ms]
};

}  // namespace tool
