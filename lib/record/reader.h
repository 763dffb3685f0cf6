// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads recordings: folders of files, files of messages, and MCAP, merged by log time. Damaged and
// truncated files are read as far as possible. An object is used on one thread.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/link/link.h>
#include <record/mcap/reader.h>
#include <record/mcap/storage.h>
#include <record/place.h>

namespace hc::record {

/// Keys of channel metadata in MCAP: on a channel of MTP, its stream; on its companion, the channel
/// for viewers, the topic of the MTP channel with the same messages.
inline constexpr const char *kStreamKey = "hypercolumn.stream", *kCompanionKey = "hypercolumn.mtp";

/// The metadata in MCAP with a module's description: what precedes its name, and the key of the
/// JSON.
inline constexpr const char* kDescriptionPrefix = "hypercolumn.description.";
inline constexpr const char* kDescriptionKey = "json";

struct StreamInfo {
  std::string name;  ///< "head_eyes.left"
  std::string type;  ///< of its messages: of ROS 2 in MCAP, else of MTP; may be empty
  std::uint64_t messages = 0;
  Time begin, end;                      ///< first and last log time; not set for MCAP
  std::vector<std::uint16_t> channels;  ///< in MCAP
  Status status = {};                   ///< why counting stopped early
};

/// A message as stored in MCAP, and its companion: the message for viewers with the same sequence
/// number, which may hold its elements. Both are in one chunk.
struct StoredPair {
  mcap::StoredMessage message;
  std::optional<mcap::StoredMessage> companion;
};

/// The messages read from MCAP files.
enum class Topics {
  Mtp,  ///< messages of MTP
  All,  ///< all messages, only with take_stored()
};

enum class StreamDetail {
  Names,
  Counts,  ///< with counts and times, for which files of messages are read completely
};

/// The MTP streams of an MCAP file, by name.
std::vector<StreamInfo> streams_of(const mcap::Summary& summary);

/// Whether a message in MCAP is one of MTP, not a copy for viewers or anything else.
bool is_mtp(const mcap::StoredMessage& message);

class Reader : public Source {
 public:
  /// @param places  recordings, or `-`. A folder has one stream per file; a file of messages is one
  ///     stream with the name of the file.
  ///
  /// Errors: NotFound (no such place or stream), Invalid, Malformed, Unsupported (MCAP without
  /// messages of MTP), System.
  static Result<std::unique_ptr<Reader>> open(const std::vector<Place>& places,
                                              const LinkOptions& options,
                                              Topics topics = Topics::Mtp);

  // take() returns messages by log time, messages of equal time in the order of places and files.
  // For files of messages, log times are the messages' times, made monotonic: a jump back by more
  // than a second (a clock was set) is removed. A message without a time gets the previous time, at
  // the beginning of a file the first one in it. Errors of take(): Truncated (once, at the end,
  // after all complete messages of all files), Malformed, TooLarge, Unsupported, System; resume()
  // continues after the damage.

  /// Log time and stream of the last message.
  [[nodiscard]] virtual Time log_time() const = 0;
  [[nodiscard]] virtual std::string_view stream() const = 0;

  /// The log time of the next message; nullopt at the end. Errors: as take().
  virtual Result<std::optional<Time>> next_time() = 0;
  /// Skips messages before this time. Call it before take().
  virtual void start_at(Time log_time) = 0;

  virtual Result<std::vector<StreamInfo>> streams(StreamDetail detail = StreamDetail::Names) = 0;
  /// All metadata, for MCAP; the latest of a name counts.
  virtual Result<std::vector<mcap::MetadataRecord>> metadata() {
    return std::vector<mcap::MetadataRecord>();
  }

  // For copying.

  /// The profile of MCAP files; empty if they have several. For other formats it is that of files
  /// that are written here.
  [[nodiscard]] virtual std::string profile() const { return mcap::StorageOptions().profile; }
  /// Calls a function with each channel of MCAP that is read, as a message without data, and with
  /// the reader of its file.
  using TakeChannel = std::function<void(const mcap::StoredMessage&, const Reader&)>;
  virtual void for_each_channel(const TakeChannel&) const {}

  /// The reader of the file that has the next message; valid after next_time().
  virtual Reader& front() { return *this; }
  /// Whether messages of several src may be mixed in the stream, as in a file written from a pipe.
  [[nodiscard]] virtual bool mixes_sources() const { return false; }
  /// The next message as stored in MCAP; nullopt at the end, and for other formats.
  /// Errors: as take().
  virtual Result<std::optional<StoredPair>> take_stored() { return std::optional<StoredPair>(); }
};

/// Opens the link or recording that a word names (place_of()).
/// Errors: as hc::open_source() and Reader::open().
Result<std::unique_ptr<Source>> open_source(std::string_view word, const LinkOptions& options);

/// Readers of one file. Internal to record.
Result<std::unique_ptr<Reader>> read_mcap(const Place& place, const LinkOptions& options,
                                          Topics topics);
Result<std::unique_ptr<Reader>> read_messages(const Place& place, const LinkOptions& options);

}  // namespace hc::record
