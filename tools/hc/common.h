// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by the verbs of hc: opening links and recordings, errors as exceptions, output, progress.

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

/// Ends a verb with a line on standard error and an exit status; with status 0 and no line if it
/// was asked to stop.
struct Failure : std::runtime_error {
  explicit Failure(const hc::Error& error)
      : std::runtime_error(error.text()),
        code(error.code),
        detail(error.detail),
        status(status_of(error.code)) {}
  Failure(hc::Code what, std::string why) : Failure(hc::Error{what, std::move(why)}) {}
  Failure(std::string_view subject, const hc::Error& error)
      : Failure(error.code, std::string(subject) + ": " + error.detail) {}
  /// Without a line, since the reason has been logged.
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
T value_or_fail(hc::Result<T> result, std::string_view subject) {
  if (!result) throw Failure(subject, result.error());
  return std::move(*result);
}

template <typename T>
T value_or_fail(hc::Result<T> result) {
  if (!result) throw Failure(result.error());
  return std::move(*result);
}

/// @param limit  largest message accepted. [byte]
hc::LinkOptions link_options(std::uint64_t limit = kDefaultLimit);

/// Opens links and recordings as named on the command line (record/place.h).
/// @param limit  largest message accepted. [byte]
std::unique_ptr<hc::Source> open_source(const std::string& uri, std::uint64_t limit);
std::unique_ptr<hc::Sink> open_sink(const std::string& uri);

std::unique_ptr<hc::record::Reader> open_recording(
    const std::vector<hc::record::Place>& places, std::uint64_t limit,
    hc::record::Topics topics = hc::record::Topics::Mtp);

/// Opens files of messages, by path.
std::unique_ptr<hc::Source> open_file_source(const std::string& path, std::uint64_t limit);
std::unique_ptr<hc::Sink> open_file_sink(const std::string& path);

/// Takes the next message; false at the end, or when asked to stop.
bool receive(hc::Source& source, hc::Message& message, const std::string& uri);

/// Like receive(), but with `is_skipping` logs damaged bytes, prefixed by `verb`, and continues
/// after them. Fails for other errors, and if the damage does not end.
bool receive(hc::Source& source, hc::Message& message, const std::string& uri,
             std::string_view verb, bool is_skipping);

/// Sends a message; false when the reader has closed.
bool send(hc::Sink& sink, const hc::Message& message, const std::string& uri);

/// Dropped messages by reason, such as "253 throttled, 8 lost without a reader"; empty if none.
std::string losses_in_words(const hc::Traffic& traffic);
/// Logs the messages dropped by a link, if any.
void say_losses(std::string_view verb, std::string_view uri, const hc::Traffic& traffic);

/// Writes to standard output; false when the reader has closed. Fails for other errors.
bool print(std::string_view text);

/// Raises the limit of open descriptors to 65536, if allowed: each module needs several, and the
/// usual limit is 1024. Not higher, since some programs close every number up to their limit.
void allow_descriptors();

/// [character]
struct TerminalSize {
  std::size_t width = 80, height = 24;
};
/// The size of the terminal; 80 x 24 if unknown.
TerminalSize terminal_size();

/// Writes lines to standard error, with control characters escaped.
void say(std::string_view lines);

using hc::find_program;
using hc::module_folder;
using hc::module_names;

/// For a word of other tools, what to write instead, after "; "; else empty. `hc` takes no program
/// of such a name on the PATH for a module.
std::string meant_command(const std::string& word);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words, std::string_view between = ", ");
/// "1 message", "2 messages"
std::string counted(std::uint64_t number, std::string_view what);

/// The path of a graph file: `name` if that file exists (not a folder), or a shipped graph of that
/// name, with or without ".toml".
std::string find_graph(const std::string& name);
/// The names of the shipped graphs, without ".toml".
std::vector<std::string> shipped_graphs();

/// "1.44 MB"
std::string bytes_in_words(std::uint64_t bytes);

/// "12 s", "3:05 min", "4:00 h", "12 d"
std::string seconds_in_words(double seconds);

/// A progress bar on standard error, if that is a terminal.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  /// @param share  0 … 1; negative if unknown.
  void show(double share, std::string_view words);

 private:
  std::string what_;
  bool on_terminal_;
  std::int64_t shown_ = 0;  // time of the last update, monotonic [ms]
};

}  // namespace tool
