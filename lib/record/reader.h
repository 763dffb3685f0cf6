// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads recordings: folders of files, files of messages, and MCAP, one or several merged by log
// time. Damaged and truncated files are read as far as possible. An object is used by one thread.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/link/link.h>
#include <record/mcap/reader.h>
#include <record/place.h>

namespace hc::record {

/// Keys of the metadata of channels in MCAP: the stream that a channel of MTP is; on its companion,
/// the channel for viewers, the topic of the channel of MTP with the same messages.
inline constexpr const char *kStreamKey = "hypercolumn.stream", *kCompanionKey = "hypercolumn.mtp";

/// A stream of a recording.
struct StreamInfo {
  std::string name;  ///< "head_eyes.left"
  std::string type;  ///< of its messages: in MCAP of ROS 2, else of MTP; may be empty
  std::uint64_t messages = 0;
  std::int64_t begin = 0, end = 0;      ///< first and last log time, not in MCAP [ns]
  std::vector<std::uint16_t> channels;  ///< in MCAP
  Status status = {};                   ///< why it could not be counted to its end
};

/// A message as MCAP stores it, and its companion: the message for viewers with the same sequence,
/// which may have its elements. They are written into one chunk.
struct StoredPair {
  mcap::StoredMessage message;
  std::optional<mcap::StoredMessage> companion;
};

/// What is read of MCAP files.
enum class Topics {
  Mtp,  ///< messages of MTP
  All,  ///< all messages, by take_stored() alone
};

enum class StreamDetail {
  Names,
  Counts,  ///< with counts and times, for which files of messages are read to their end
};

/// The streams of MTP in an MCAP file, by name.
std::vector<StreamInfo> streams_of(const mcap::Summary& summary);

/// Whether a message in MCAP is one of MTP, and not a copy for viewers or something else.
bool is_mtp(const mcap::StoredMessage& message);

class Reader : public Source {
 public:
  /// @param places  recordings, or `-`. A folder has one stream for each file; a file of messages
  ///     is one stream with the name of the file.
  ///
  /// Errors: NotFound (no such place or stream), Invalid, Malformed, Unsupported (MCAP without
  /// messages of MTP), System.
  static Result<std::unique_ptr<Reader>> open(const std::vector<Place>& places,
                                              const LinkOptions& options,
                                              Topics topics = Topics::Mtp);

  // take() returns messages by log time, those with equal times in the order of places and files.
  // Files of messages have no log times: those of their messages are used, made monotonic. Where
  // they jump back by more than a second (a clock was set), the jump is removed. A message without
  // a time gets the time before it, at the begin of a file the first one that there is. Errors of
  // take(): Truncated (once, at the end, after all complete messages of all files), Malformed,
  // TooLarge, Unsupported, System; resume() continues after the damage.

  /// Log time and stream of the last message. [ns since the Unix epoch]; 0: unknown.
  [[nodiscard]] virtual std::int64_t log_time() const = 0;
  [[nodiscard]] virtual std::string_view stream() const = 0;

  /// The log time of the next message; nothing at the end. Errors: as take().
  virtual Result<std::optional<std::int64_t>> next_time() = 0;
  /// Skips messages before this time. To be called before take().
  virtual void start_at(std::int64_t log_time) = 0;

  virtual Result<std::vector<StreamInfo>> streams(StreamDetail detail = StreamDetail::Names) = 0;
  /// The newest metadata of each name, of MCAP.
  virtual Result<std::map<std::string, mcap::StringMap>> metadata() {
    return std::map<std::string, mcap::StringMap>();
  }

  // For Writer::copy().

  /// The reader of the file with the next message; valid after next_time().
  virtual Reader& front() { return *this; }
  /// Whether messages of several src may be mixed in the stream, as in a file written from a pipe.
  [[nodiscard]] virtual bool mixes_sources() const { return false; }
  /// The next message of MCAP as it is stored; nothing at the end, and if this is not MCAP.
  /// Errors: as take().
  virtual Result<std::optional<StoredPair>> take_stored() { return std::optional<StoredPair>(); }
};

/// Opens the link or recording that a word names, as place_of().
/// Errors: as hc::open_source() and Reader::open().
Result<std::unique_ptr<Source>> open_source(std::string_view word, const LinkOptions& options);

/// Readers of one file. Internal to record.
Result<std::unique_ptr<Reader>> read_mcap(const Place& place, const LinkOptions& options,
                                          Topics topics);
Result<std::unique_ptr<Reader>> read_messages(const Place& place, const LinkOptions& options);

}  // namespace hc::record
