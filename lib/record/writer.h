// SPDX-License-Identifier: Apache-2.0
#pragma once
// Records streams of messages: into a folder, a file of messages, or MCAP. What is there already
// stays, and the recording goes beside it; the first failure, as of a full disk, ends it, and what
// was written is whole. An object is used by one thread.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/log.h>
#include <hc/link/link.h>
#include <record/format.h>
#include <record/place.h>
#include <record/reader.h>

namespace hc::record {

struct WriterOptions : FormatOptions {
  /// Streams that are known, numbered in this order; add_stream() may add others.
  std::vector<std::string> streams;
  /// A stream: what is kept of the last time is saved when its first number becomes other than 0.
  std::string when;
  LogSink log;                   ///< what was saved, and which messages are dropped; may be empty
  const Clock* clock = nullptr;  ///< null: the machine's
};

/// What a recording came to.
struct Written {
  std::string place;               ///< the folder or file; of several what they are numbered after
  std::vector<std::string> files;  ///< those in which something is
  std::uint64_t messages = 0;      ///< that are in them
  std::uint64_t bytes = 0;         ///< of the elements of all that came
  std::uint64_t lost = 0;          ///< messages that came and are in none
  Status status;                   ///< why the recording ended before it was closed
};

class Writer {
 public:
  /// Errors: Invalid (options that this kind of place does not have; names of streams that cannot
  /// be files), System; nothing is left of the recording then.
  static Result<std::unique_ptr<Writer>> open(const Place& place, const WriterOptions& options);
  /// Ends as close() does.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// A further stream; gives its number. Where there is one of the name, it is called NAME_2.
  Result<std::size_t> add_stream(std::string_view name);
  /// The stream for messages of a src that come over a link: one for each src, since a pipe may
  /// carry both eyes. The first is called as the link, others NAME.src_N.
  Result<std::size_t> stream_of(std::size_t link, const std::string& name, std::int32_t src);

  // Errors of all below: System (the disk); each later call gives the same.

  /// Records a message. Waits while the disk is behind. One that there is no place for is dropped,
  /// which is logged once for each stream.
  /// @param log_time  when it was recorded before [ns since the Unix epoch]; nothing or 0: now.
  Status add(std::size_t stream, const Message& message, std::optional<std::int64_t> log_time = {});

  /// Whether copy() copies what MCAP has beside messages of MTP.
  [[nodiscard]] bool copies_all() const { return format_->copies_all(); }
  /// Records the next message of another recording, with its stream and log time; from MCAP to MCAP
  /// byte for byte as it stands there. False: there is none. Errors: of the reader too.
  Result<bool> copy(Reader& reader);

  /// A line of the graph's log, and what else is said of it; only MCAP keeps these.
  Status log(const LogLine& line);
  Status metadata(const std::string& name, const mcap::Words& words);

  /// To be called a few times a second: writes what has been gathered for long enough.
  Status poll();
  /// Writes what is kept of the last time into a file of its own, if this recording does that, and
  /// logs its name.
  void save();

  /// Writes what is left.
  const Written& close();

  /// The time on the wall by the monotonic clock, since the recording began: whatever happens to
  /// the wall clock, it goes on evenly. [ns since the Unix epoch]
  [[nodiscard]] std::int64_t now();
  /// What was recorded so far.
  [[nodiscard]] const Written& written() const { return written_; }

 private:
  Writer(std::unique_ptr<Format> format, const WriterOptions& options);
  void say(Level severity, const std::string& line) const;
  /// Ends the recording if it has failed, other than for one message.
  Status note(const Status& status);
  /// Has a message of so many bytes written, and counts it.
  template <typename Write>
  Status record(std::size_t bytes, const Write& write);
  void save_when_set(const Message& message);

  std::unique_ptr<Format> format_;
  const WriterOptions options_;
  SystemClock system_clock_;
  const Clock& clock_;
  std::optional<std::int64_t> to_wall_;  // of the monotonic clock
  std::vector<std::string> names_;       // of streams
  /// Streams by src, of what comes over a link by a name.
  std::map<std::pair<std::size_t, std::string>, std::map<std::int32_t, std::size_t>> links_;
  std::set<std::size_t> dropping_;
  Written written_;
  bool was_set_ = false, is_closed_ = false;
};

/// The end of a link that a place is: it records what is sent, a stream for each src, or sends it.
Result<std::unique_ptr<Sink>> open_sink(const Place& place, const LinkOptions& options);

}  // namespace hc::record
