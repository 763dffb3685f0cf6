// SPDX-License-Identifier: Apache-2.0
#pragma once
// A recording that a page makes, an MCAP file (spec/page.md, section 6). Functions that wait for
// the disk must not run on the server's thread, which also handles stops.

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <client/tap.h>
#include <hc/base/log.h>
#include <record/writer.h>

/// Whether a recording may have that name: 1 to 40 letters, digits, `-` and `_`.
bool is_recording_name(std::string_view name);

/// A running recording, until end(). A write error, e.g. on a full disk, ends it; the file keeps
/// all before. Its destructor may wait for the disk, unless it has ended.
class Recorder {
 public:
  struct Options {
    std::string folder, frames;  ///< of recordings; of the graph, as text
    hc::LogSink log;             ///< called on any thread
  };

  /// Errors: Invalid (invalid name or port; the recording exists), System.
  static hc::Result<std::unique_ptr<Recorder>> begin(const hc::RunningGraph& graph,
                                                     const Options& options,
                                                     const std::string& name,
                                                     const std::vector<std::string>& ports);
  ~Recorder() { end(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Waits until all is written.
  void end();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<std::string>& ports() const { return ports_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] double seconds() const;
  /// False after a write error: call end().
  [[nodiscard]] bool goes_on() const { return !has_failed_; }

 private:
  Recorder(std::unique_ptr<hc::record::Writer> writer, hc::LogSink log, std::string name,
           std::vector<std::string> ports);
  /// Called on the threads of taps.
  void write(std::size_t stream, const hc::Message& message);
  void fail(const hc::Error& error);

  const hc::LogSink log_;
  const std::string name_;
  const std::vector<std::string> ports_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::atomic<std::uint64_t> bytes_{0};
  std::atomic<bool> has_failed_{false};
  std::mutex mutex_;  // guards the writer
  std::unique_ptr<hc::record::Writer> writer_;
  std::vector<std::unique_ptr<hc::Tap>> taps_;
};
