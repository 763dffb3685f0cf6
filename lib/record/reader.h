// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads recordings: folders, files of messages and MCAP alike, one or several at once, in the order
// of their log times. What is damaged, or has no end, is read as far as it is whole. A reader is
// the source of a link too. An object is used by one thread.

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

/// A stream of a recording.
struct StreamInfo {
  std::string name;  ///< "head_eyes.left"
  std::string type;  ///< of its messages: of ROS 2 in MCAP, else of MTP; may be empty
  std::vector<std::string> topics;  ///< those that it has in MCAP
  std::uint64_t messages = 0;
  std::int64_t begin = 0, end = 0;  ///< log times, of a folder or file alone [ns]
};

/// The streams of MTP in a file of MCAP, by name.
std::vector<StreamInfo> streams_of(const mcap::Summary& summary);

/// A message as a file of MCAP has it.
struct Stored {
  const mcap::Reader* file = nullptr;  ///< numbers channels
  const mcap::ChannelRecord* channel = nullptr;
  const mcap::SchemaRecord* schema = nullptr;  ///< null: none
  mcap::StoredMessage message;
  bool is_mtp = false;  ///< one of MTP; another may stand beside it, for viewers
};

class Reader : public Source {
 public:
  /// @param places  recordings, or `-`. A folder has the streams of its files; a file of messages
  /// is
  ///     one stream, which is called as the file.
  /// @param all  for take_stored(): what MCAP has beside streams of MTP, too.
  ///
  /// Errors: NotFound (no such place or stream), Invalid, Malformed, Unsupported (MCAP without
  /// messages of MTP), System.
  static Result<std::unique_ptr<Reader>> open(const std::vector<Place>& places,
                                              const LinkOptions& options, bool all = false);

  // take() gives messages by log time, equal ones in the order of files and in them. A file of
  // messages without log times has those of its messages instead, never going back: where a clock
  // was set back it goes on from there. A message without a time goes with the one before it, the
  // first with the first that has one. Errors of take(): Truncated (all that is whole was given),
  // Malformed, TooLarge, Unsupported, System; resume() continues behind what is damaged.

  /// Of the message that take() gave last. [ns since the Unix epoch]; 0: not known.
  [[nodiscard]] virtual std::int64_t log_time() const = 0;
  [[nodiscard]] virtual std::string_view stream() const = 0;

  /// The log time of the next message; nothing at the end. Errors: as take().
  virtual Result<std::optional<std::int64_t>> next_time() = 0;
  /// Skips messages of before. Before the first one is taken.
  virtual void start_at(std::int64_t log_time) = 0;

  /// @param counted  with numbers and times, for which a folder or file of messages is read whole.
  virtual Result<std::vector<StreamInfo>> streams(bool counted = false) = 0;
  /// The newest metadata of each name, of MCAP.
  virtual Result<std::map<std::string, mcap::Words>> metadata() = 0;

  /// Whether a stream is of one output, whatever src its messages have; a file may have come from a
  /// pipe instead.
  [[nodiscard]] virtual bool is_of_outputs() const { return true; }
  /// The reader of the file that has the next message, after next_time().
  virtual Reader& front() { return *this; }
  /// Whether it is MCAP, which has more than messages of MTP; then the next message as it is,
  /// nothing at the end. Errors: as take().
  [[nodiscard]] virtual bool has_more() const { return false; }
  virtual Result<std::optional<Stored>> take_stored() { return std::optional<Stored>(); }
};

/// The source that a word names, a link or a recording.
/// Errors: as hc::open_source() and Reader::open().
Result<std::unique_ptr<Source>> open_source(std::string_view word, const LinkOptions& options);

/// Each a reader of one place. Internal to record.
Result<std::unique_ptr<Reader>> read_mcap(const Place& place, const LinkOptions& options, bool all);
Result<std::unique_ptr<Reader>> read_messages(const Place& place, const LinkOptions& options);

}  // namespace hc::record
