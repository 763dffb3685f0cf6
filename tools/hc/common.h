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

#include <hc/link/link.h>

namespace tool {

/// Ends a verb with one line on standard error and an exit status; quietly with 0 when it was told
/// to stop.
struct Failure : std::runtime_error {
  explicit Failure(const hc::Error& error)
      : std::runtime_error(error.text()), status(status_of(error.code)) {}
  Failure(std::string_view who, const hc::Error& error)
      : Failure(hc::Error{error.code, std::string(who) + ": " + error.detail}) {}
  int status;

 private:
  static int status_of(hc::Code code) {
    return code == hc::Code::Stopped ? 0 : code == hc::Code::Usage ? 2 : 1;
  }
};

template <typename T>
T value_or_fail(hc::Result<T> result, std::string_view who) {
  if (!result) throw Failure(who, result.error());
  return std::move(*result);
}

/// A descriptor that becomes readable with SIGINT or SIGTERM; the second one kills.
int stop_descriptor();

/// Links as the command line names them. `limit` bounds the elements that are taken. [byte]
std::unique_ptr<hc::Source> open_source(const std::string& uri, std::uint64_t limit);
std::unique_ptr<hc::Sink> open_sink(const std::string& uri);

/// Takes the next message; false at the end, or when we are told to stop.
bool receive(hc::Source& source, hc::Message& message, const std::string& uri);

/// Sends a message; false when nobody reads any more.
bool send(hc::Sink& sink, const hc::Message& message);

/// Writes to standard output; false when nobody reads any more.
bool print(std::string_view text);

/// One line to the person, on standard error.
void say(std::string_view line);

/// The folder of the modules, and a program by its name there or in PATH; empty when there is none.
std::filesystem::path module_folder();
std::string find_program(const std::string& name);

/// The names of all modules there are.
std::vector<std::string> module_names();

/// "1.44 MB"
std::string bytes_in_words(double bytes);

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
