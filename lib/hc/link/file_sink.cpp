// SPDX-License-Identifier: Apache-2.0
// `file:PATH` as a sink. It overwrites nothing (os/new_file.h). Options:
// - `append=1`: appends after the last complete message. Otherwise, if the file has contents,
// writes
//   a new file beside it: x_2.mtp.
// - `optional=1`: if the file cannot be written, logs an error once and drops the messages
//   (Traffic::dropped_disconnect), so that a full disk does not stop the writing module.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

#include <hc/base/place_word.h>
#include <hc/link/stream/ends.h>
#include <hc/link/transports.h>
#include <hc/mtp/stream_reader.h>
#include <hc/os/new_file.h>

namespace hc::internal {
namespace {

/// Seeks to the end of the last complete message and truncates a message that a killed writer left
/// incomplete. False: the file is damaged or is not a recording.
Result<bool> seek_messages_end(int file) {
  StreamReader reader({~std::uint64_t{0}});
  Message message;
  off_t at = 0;
  const auto end = ::lseek(file, 0, SEEK_END);
  while (true) {
    auto got = reader.next(message);
    if (!got) return false;
    if (*got) continue;
    const auto space = reader.space();
    auto size = static_cast<ssize_t>(
        std::min<std::uint64_t>(space.size(), static_cast<std::uint64_t>(end - at)));
    // Skip the elements of large messages.
    if (reader.missing() == 0) size = ::pread(file, space.data(), space.size(), at);
    if (size < 0) return system_error("read", "");
    if (size == 0) break;
    reader.commit(static_cast<std::size_t>(size));
    at += size;
  }
  const auto whole = static_cast<off_t>(reader.message_begin());
  if (::ftruncate(file, whole) != 0 || ::lseek(file, whole, SEEK_SET) != whole)
    return system_error("ftruncate", "");
  return true;
}

/// Opens a file for writing without overwriting its contents.
Result<Descriptor> open_for_writing(const Uri& uri, bool appends, const LinkOptions& options) {
  if (is_written_in_place(uri.rest))
    return open_path(uri, O_WRONLY | O_CREAT | O_APPEND, options.stop);
  if (appends) {
    auto file = HC_TRY(continue_file(uri.rest));
    auto is_whole = HC_TRY(seek_messages_end(file.descriptor.get()));
    if (is_whole) return std::move(file.descriptor);
  }
  auto file = HC_TRY(begin_file(uri.rest));
  if (file.path != uri.rest && options.log)
    options.log(Level::Notice, "the file stays as it is; continuing in " + file.path);
  return std::move(file.descriptor);
}

/// Drops messages once the file cannot be written.
class OptionalFile final : public Sink {
 public:
  OptionalFile(std::string path, Result<std::unique_ptr<Sink>> sink, LogSink log)
      : path_(std::move(path)), log_(std::move(log)) {
    if (sink)
      sink_ = std::move(*sink);
    else
      end(sink.error());
  }

  Status send(const Message& message) override {
    if (has_ended_) {
      ++lost_;
      return {};
    }
    auto sent = sink_->send(message);
    if (sent || sent.error().code == Code::Stopped) return sent;
    end(sent.error());
    ++lost_;
    return {};
  }

  Status close() override {
    if (has_ended_) return {};
    if (auto closed = sink_->close(); !closed) end(closed.error());
    return {};
  }

  void abandon() override {
    if (!has_ended_) sink_->abandon();
  }

  [[nodiscard]] Traffic traffic() const override {
    Traffic traffic = sink_ ? sink_->traffic() : Traffic();
    traffic.messages += lost_;
    traffic.dropped_disconnect += lost_;
    return traffic;
  }

 private:
  void end(const Error& why) {
    has_ended_ = true;
    if (log_) log_(Level::Error, "recording into " + path_ + " ended: " + why.detail);
  }

  const std::string path_;
  const LogSink log_;
  std::unique_ptr<Sink> sink_;  // null: the file could not be opened
  bool has_ended_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_file_sink(const Uri& uri, const LinkOptions& options) {
  if (is_mcap_path(uri.rest))
    return Error{Code::Invalid, "links do not write MCAP; use hc record " + uri.rest};
  auto is_set = [&](const char* key) {
    const auto number = number_option(uri, key, 0);
    return number && *number != 0;
  };
  auto file = open_for_writing(uri, is_set("append"), options);
  if (!is_set("optional")) {
    if (!file) return file.error();
    return make_stream_sink({std::move(*file)}, uri, options);
  }
  if (!file && file.error().code == Code::Stopped) return file.error();
  auto sink = file ? make_stream_sink({std::move(*file)}, uri, options) : file.error();
  if (!sink && sink.error().code == Code::Invalid) return sink.error();
  return std::unique_ptr<Sink>(new OptionalFile(uri.rest, std::move(sink), options.log));
}

}  // namespace hc::internal
