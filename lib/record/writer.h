// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes recordings: folders of files, files of messages, and MCAP. Existing recordings are never
// overwritten: the new one gets a free name beside them. What was added is written within a
// second. The first error, such as a full disk, ends a recording; what was written until then can
// be read. An object is used by one thread.

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

/// Those of StorageOptions, `when`, `frames` and `chunk_bytes` are for MCAP.
struct WriterOptions : mcap::StorageOptions {
  /// Streams known at the start, numbered in this order; add_stream() adds others.
  std::vector<std::string> streams;
  bool append = false;  ///< continue the files of a folder
  /// With `last`: save() when the first number of a message of this stream becomes other than 0.
  std::string when;
  /// Frames of the graph as text (spec/graph.md, G31), recorded on /tf and /tf_static.
  std::string frames;
  std::size_t chunk_bytes = std::size_t{4} << 20;  ///< size of a chunk, uncompressed
  LogSink log;                   ///< gets names of saved files, and dropped streams; may be empty
  const Clock* clock = nullptr;  ///< null: the machine's
};

/// The state of a recording, or its result after close().
struct Written {
  /// The folder or file, also where that is not the one asked for; with `split` or `last` its base
  /// name.
  std::string place;
  std::vector<std::string> files;  ///< files with contents
  std::uint64_t messages = 0;      ///< written
  std::uint64_t bytes = 0;         ///< of the elements of all messages given
  std::uint64_t lost = 0;          ///< messages given and not written
  Status status;                   ///< the error that ended the recording early
};

class Writer {
 public:
  /// Errors: Invalid (options that this kind of place does not have; names of streams that cannot
  /// be file names), System. Leaves no files behind then.
  static Result<std::unique_ptr<Writer>> open(const Place& place, const WriterOptions& options);
  /// As close().
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Adds a stream; returns its number. A name that is taken becomes NAME_2.
  Result<std::size_t> add_stream(std::string_view name);
  /// The stream for messages of a src, added if it is new. A pipe may carry both eyes, so each src
  /// has its own: the first has the name, others NAME.src_N.
  /// @param from  identifies the link or file: those of the same name have streams of their own.
  Result<std::size_t> stream_of(const void* from, const std::string& name, std::int32_t src);

  // Errors of all below: System (the disk), from then on always the same.

  /// Records a message; blocks while the disk is slower. A message that does not fit into the file
  /// is dropped, which is logged once for each stream.
  /// @param log_time  when it was first recorded [ns since the Unix epoch]; nothing or 0: now.
  Status add(std::size_t stream, const Message& message, std::optional<std::int64_t> log_time = {});

  /// What copy() keeps of MCAP files, and so has to be read.
  [[nodiscard]] Topics copied_topics() const { return mcap_ ? Topics::All : Topics::Mtp; }
  /// Copies the next message of a recording with its stream and log time, from MCAP to MCAP byte
  /// for byte. False at the end. Errors: also those of the reader.
  Result<bool> copy(Reader& reader);

  /// A line of the graph's log, and metadata; ignored other than in MCAP.
  Status log(const LogLine& line);
  Status metadata(const std::string& name, const mcap::StringMap& words);

  /// With `last`: writes what is in memory into a new file, and logs its name, or why there is
  /// none.
  void save();

  /// Writes all that is buffered, and ends the files.
  const Written& close();

  /// The time for new messages: the wall clock's at the first call, from then on advanced by the
  /// monotonic clock, so that setting the wall clock has no effect. [ns since the Unix epoch]
  [[nodiscard]] std::int64_t now();
  [[nodiscard]] const Written& written() const { return written_; }

 private:
  struct File {
    std::string path;
    Descriptor lock;             // of a new file, as long as it is written
    std::unique_ptr<Sink> sink;  // null: closed
    bool is_new = false;         // it was not there before
  };

  Writer(const Place& place, const WriterOptions& options);
  Status begin(const Place& place);
  Status begin_file(const std::string& path);
  /// Removes a file that was begun in vain: as an empty one it would send the next attempt to
  /// another folder.
  static void remove_unused(const File& file);
  /// Closes all files.
  Status end();
  [[nodiscard]] Error named(const File& file, const Error& error) const;
  void say(Level severity, const std::string& line) const;
  /// Ends the recording after an error, unless it is only about one message.
  Status end_if_failed(const Status& status);
  /// Counts a message of so many bytes, and writes it.
  template <typename Write>
  Status record(std::size_t bytes, const Write& write);
  template <typename Write>
  Status to_mcap(const Write& write);
  Status write(std::size_t stream, const Message& message, std::int64_t log_time);
  void save_when_set(const Message& message);

  const WriterOptions options_;
  SystemClock system_clock_;
  const Clock& clock_;
  const bool is_folder_;
  std::optional<std::int64_t> to_wall_;  // to be added to the monotonic clock [ns]
  std::vector<std::string> names_;       // of streams
  std::unique_ptr<McapWriter> mcap_;     // null: they are written to files of messages
  std::vector<File> files_;              // one for each stream of a folder, else one for all
  std::set<std::string> file_names_;
  // Streams by src, of each link or file and name.
  std::map<std::pair<const void*, std::string>, std::map<std::int32_t, std::size_t>> links_;
  std::set<std::size_t> dropping_;
  Written written_;
  bool was_set_ = false, is_closed_ = false;
};

/// A sink that records into a place, with a stream for each src; where the place is a link, its
/// end.
Result<std::unique_ptr<Sink>> open_sink(const Place& place, const LinkOptions& options);

}  // namespace hc::record
