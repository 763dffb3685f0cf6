// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a recording is written: Writer has one of these for a folder or file (folder_writer.cpp), and
// for MCAP (mcap_writer.h). Internal to record.

#include <chrono>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/contract/log_line.h>
#include <hc/mtp/message.h>
#include <record/mcap/storage.h>
#include <record/place.h>

namespace hc::record {

struct Stored;

/// Of MCAP, but `append`.
struct FormatOptions : mcap::StorageOptions {
  bool append = false;  ///< the files of a folder are continued
  std::string
      frames;  ///< of the graph as text (spec/graph.md, G31), recorded on /tf and /tf_static
  /// Bytes of messages that make a chunk, and how long one is gathered at most.
  std::size_t chunk_bytes = std::size_t{4} << 20;
  std::chrono::milliseconds chunk_time{500};
  std::size_t backlog = std::size_t{256} << 20;  ///< of chunks that wait to be written [byte]
};

/// A name that none of `taken` is, and now is one: the wanted one, or that with a number behind it.
inline std::string take_name(std::set<std::string>& taken, const std::string& wanted) {
  std::string name = wanted;
  for (int i = 2; !taken.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
  return name;
}

class Format {
 public:
  virtual ~Format() = default;
  /// Streams are numbered in the order in which they are added. One of a name that there is gets
  /// another.
  virtual Status add_stream(const std::string& name) = 0;
  /// Errors: TooLarge (there is no place for this message, but for those of other streams).
  virtual Status write(std::size_t stream, const Message& message, std::int64_t log_time) = 0;
  [[nodiscard]] virtual bool copies_all() const { return false; }
  /// A message of another file. Errors: as above.
  virtual Status write(const Stored&) { return {}; }
  virtual Status log(std::int64_t /*time*/, const LogLine& /*line*/) { return {}; }
  virtual Status metadata(const std::string& /*name*/, const mcap::Words& /*words*/) { return {}; }
  virtual Status poll() { return {}; }
  [[nodiscard]] virtual bool keeps_last() const { return false; }
  virtual Result<std::string> save() { return Error{Code::Invalid, "nothing is kept in memory"}; }
  virtual Status close() = 0;

  [[nodiscard]] virtual const std::string& place() const = 0;
  // After close().
  [[nodiscard]] virtual std::vector<std::string> files() const = 0;
  /// Messages that write() was given and that are in no file, without those that were TooLarge.
  [[nodiscard]] virtual std::uint64_t lost() const = 0;
};

/// @param place  with its final path is begun: nothing is written over. Errors: Invalid, System.
Result<std::unique_ptr<Format>> open_folder(const std::string& folder,
                                            const std::vector<std::string>& streams, bool append);
Result<std::unique_ptr<Format>> open_message_file(const std::string& path, const LogSink& log);
Result<std::unique_ptr<Format>> open_mcap(const FormatOptions& options);

}  // namespace hc::record
