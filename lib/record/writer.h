// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes recordings: folders of files, files of messages, and MCAP. Never overwrites a recording:
// the new one gets a free name. Data is written within a second. The first error, such as a full
// disk, ends the recording; what has been written remains readable. An object is used on one
// thread.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/log.h>
#include <hc/contract/log_line.h>
#include <hc/link/link.h>
#include <hc/os/descriptor.h>
#include <record/mcap/storage.h>
#include <record/place.h>
#include <record/reader.h>

namespace hc::record {

class McapWriter;

/// StorageOptions, `when`, `frames` and `chunk_bytes` are only for MCAP.
struct WriterOptions : mcap::StorageOptions {
  /// Streams known at the start, numbered in this order; add_stream() adds others.
  std::vector<std::string> streams;
  bool append = false;  ///< continue the files of a folder
  /// With `last`: save() when the first number of this stream's messages becomes non-zero.
  std::string when;
  /// Frames of the graph as text (spec/graph.md, G31), recorded on /tf and /tf_static.
  std::string frames;
  std::size_t chunk_bytes = std::size_t{4} << 20;  ///< size of a chunk, uncompressed
  LogSink log;                   ///< logs saved files and dropped streams; may be empty
  const Clock* clock = nullptr;  ///< null: the machine's
};

/// The state of a recording, or its result after close().
struct Written {
  /// The folder or file, which may differ from the requested one; with `split` or `last`, the name
  /// without number.
  std::string place;
  std::vector<std::string> files;  ///< files with contents that are still there
  std::uint64_t messages = 0;   ///< written; after close(), in the files, also of those moved since
  std::uint64_t bytes = 0;      ///< of the elements of all messages passed
  std::uint64_t lost = 0;       ///< messages passed but not written
  std::uint64_t discarded = 0;  ///< messages removed by `keep`, or by `last` and not saved
  Status status;                ///< the error that ended the recording
};

class Writer {
 public:
  /// Errors: Invalid (options that this kind of place does not support; names of streams that
  /// cannot be file names), System. No files remain then.
  static Result<std::unique_ptr<Writer>> open(const Place& place, const WriterOptions& options);
  /// Calls close().
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Adds a stream; returns its number. If the name is taken, NAME_2 is used.
  Result<std::size_t> add_stream(std::string_view name);
  /// The stream for messages of a src, added if it is new. A pipe may carry several, such as both
  /// eyes: the first src gets the name, others NAME.src_N.
  /// @param from  identifies the link or file; streams of different ones are separate.
  Result<std::size_t> stream_of(const void* from, const std::string& name, std::int32_t src);

  // Errors of all below: System (the disk); later calls return the same error.

  /// Records a message; blocks while the disk is slower. A message that does not fit into the file
  /// is dropped, which is logged once per stream.
  /// @param log_time  when it was first recorded; Time{}: now.
  Status add(std::size_t stream, const Message& message, Time log_time = {});

  /// The topics that must be read from MCAP files for copy().
  [[nodiscard]] Topics copied_topics() const { return mcap_ ? Topics::All : Topics::Mtp; }
  /// Copies the metadata and channels of a recording from MCAP to MCAP, also channels without a
  /// message, before the first copy(). Errors: also those of the reader.
  Status copy_head(Reader& reader);
  /// Copies the next message of a recording with its stream and log time, byte for byte from MCAP
  /// to MCAP. False at the end. Errors: also those of the reader.
  Result<bool> copy(Reader& reader);

  /// A line of the graph's log, and metadata; ignored for formats other than MCAP.
  Status log(const LogLine& line);
  Status metadata(const std::string& name, const mcap::StringMap& words);

  /// With `last`: writes the messages in memory to a new file and logs its name or the error.
  void save();

  /// Fails if a file was removed or renamed, since what is written to it is lost. Those of `split`
  /// and `last` are not checked. Errors: NotFound.
  [[nodiscard]] Status check_places() const;

  /// Writes all buffered data and closes the files.
  const Written& close();

  /// The time for new messages: the wall clock at the first call, advanced by the monotonic clock,
  /// so that setting the wall clock has no effect.
  [[nodiscard]] Time now();
  [[nodiscard]] const Written& written() const { return written_; }

 private:
  struct File {
    std::string path;
    Descriptor lock;             // on a new file, while it is written
    std::unique_ptr<Sink> sink;  // null: closed
    bool is_new = false;         // it did not exist before
  };

  Writer(const Place& place, const WriterOptions& options);
  Status begin(const Place& place);
  Status begin_file(const std::string& path);
  /// Removes an unused new file: an empty one would make the next attempt use another folder.
  static void remove_unused(const File& file);
  Status end();
  [[nodiscard]] Error named(const File& file, const Error& error) const;
  void say(Level severity, const std::string& line) const;
  /// Ends the recording after an error, unless that concerns only one message.
  Status end_if_failed(const Status& status);
  /// Counts and writes a message of `bytes`.
  template <typename Write>
  Status record(std::size_t bytes, const Write& write);
  template <typename Write>
  Status to_mcap(const Write& write);
  Status write(std::size_t stream, const Message& message, Time log_time);
  void save_when_set(const Message& message);

  const WriterOptions options_;
  SystemClock system_clock_;
  const Clock& clock_;
  const bool is_folder_;
  std::optional<std::chrono::nanoseconds> to_wall_;  // to be added to the monotonic clock
  std::vector<std::string> names_;                   // of streams
  std::unique_ptr<McapWriter> mcap_;                 // null: files of messages
  std::vector<File> files_;                          // one per stream of a folder, else one for all
  std::set<std::string> file_names_;
  // Streams by src, for each link or file and name.
  std::map<std::pair<const void*, std::string>, std::map<std::int32_t, std::size_t>> links_;
  std::set<std::size_t> dropping_;
  Written written_;
  bool was_set_ = false, is_closed_ = false;
};

/// A sink that records to a place, with a stream per src; if the place is a link, its sink.
Result<std::unique_ptr<Sink>> open_sink(const Place& place, const LinkOptions& options);

}  // namespace hc::record
