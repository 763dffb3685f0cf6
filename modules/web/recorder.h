// SPDX-License-Identifier: Apache-2.0
#pragma once
// Recordings that a page makes: a folder for each, a file MODULE.PORT.mtp for each output
// (spec/page.md, section 6).

#include <atomic>
#include <chrono>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <client/tap.h>
#include <hc/base/log.h>
#include <web/server.h>

namespace web = hc::web;

/// Whether a recording may be called so: 1 to 40 letters, digits, `-` and `_`.
bool is_recording_name(std::string_view name);
/// Whether a text is MODULE.PORT.
bool is_port_name(std::string_view text);

struct Recorded {
  std::string name;
  std::uintmax_t bytes = 0;
  std::vector<std::string> streams;  ///< MODULE.PORT
};

/// The recordings in a folder, by name.
std::vector<Recorded> list_recordings(const std::string& folder);

/// A file of a recording, to be sent as long as it is now. Errors: NotFound.
hc::Result<web::Part> recorded_file(const std::string& folder, const std::string& name,
                                    const std::string& port);

/// All files of a recording as one archive (POSIX.1-2001, pax), to be sent. Errors: NotFound.
hc::Result<std::vector<web::Part>> archive_of(const std::string& folder, const std::string& name);

/// A recording that is being made, until it is destroyed. What cannot be written, on a full disk,
/// ends it: what was written before is kept.
class Recorder {
 public:
  /// Errors: Invalid (a name or port that is none; the recording exists), System.
  static hc::Result<std::unique_ptr<Recorder>> begin(const hc::RunningGraph& graph,
                                                     const std::string& folder,
                                                     const std::string& name,
                                                     const std::vector<std::string>& ports,
                                                     const hc::LogSink& log);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<std::string>& ports() const { return ports_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] double seconds() const;
  /// Whether a file could not be written: the recording is to be ended.
  [[nodiscard]] bool has_failed() const { return has_failed_; }

 private:
  class Track;

  Recorder(const hc::RunningGraph& graph, std::string path, std::string name,
           std::vector<std::string> ports, const hc::LogSink& log);

  const std::string path_, name_;
  const std::vector<std::string> ports_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<bool> has_failed_{false};
  std::vector<std::unique_ptr<Track>> tracks_;
};
