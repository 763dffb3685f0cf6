// SPDX-License-Identifier: Apache-2.0
// Recordings of messages and nothing else: a file STREAM.mtp for each stream, or one file for all.
// Small messages are written from a buffer: that the disk is full is noticed at the next one, or at
// the end.
#include <filesystem>
#include <utility>

#include <hc/link/link.h>
#include <record/format.h>

namespace hc::record {
namespace {

namespace fs = std::filesystem;

class MessageFiles final : public Format {
 public:
  /// @param folder  empty: all streams go into `file`.
  MessageFiles(std::string folder, std::string file, bool append, LogSink log)
      : folder_(std::move(folder)), file_(std::move(file)), append_(append), log_(std::move(log)) {}

  Status add_stream(const std::string& name) override {
    if (folder_.empty() && !files_.empty()) return {};
    if (!folder_.empty() && (name.empty() || name.find('/') != std::string::npos))
      return Error{Code::Invalid, "streams: \"" + name + "\" cannot be a file name"};
    auto path = folder_.empty() ? file_ : stream_file(folder_, take_name(names_, name));
    LinkOptions options;
    options.log = log_;
    Uri uri{"file", path, {}};
    if (append_) uri.options = {{"append", "1"}};
    auto sink = hc::open_sink(uri, options);
    if (!sink) return sink.error();
    files_.push_back({std::move(path), std::move(*sink)});
    return {};
  }

  Status write(std::size_t stream, const Message& message, std::int64_t) override {
    auto& [path, sink] = files_[folder_.empty() ? 0 : stream];
    auto sent = sink->send(message);
    if (sent) return sent;
    ++lost_;
    return named(path, sent.error());
  }

  Status close() override {
    Status status;
    for (auto& [path, sink] : files_) {
      if (sink == nullptr) continue;
      auto closed = sink->close();
      if (!closed && status) status = named(path, closed.error());
      lost_ += sink->traffic().dropped_disconnect;
      sink.reset();
    }
    return status;
  }

  [[nodiscard]] const std::string& place() const override {
    return folder_.empty() ? file_ : folder_;
  }
  [[nodiscard]] std::vector<std::string> files() const override {
    std::vector<std::string> paths;
    for (const auto& each : files_) paths.push_back(each.path);
    return paths;
  }
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }

 private:
  struct File {
    std::string path;
    std::unique_ptr<Sink> sink;  // null: closed
  };
  [[nodiscard]] Error named(const std::string& path, const Error& error) const {
    return {error.code, folder_.empty() ? error.detail : path + ": " + error.detail};
  }

  const std::string folder_, file_;
  const bool append_;
  const LogSink log_;
  std::set<std::string> names_;
  std::vector<File> files_;
  std::uint64_t lost_ = 0;
};

}  // namespace

Result<std::unique_ptr<Format>> open_message_file(const std::string& path, const LogSink& log) {
  auto file = std::make_unique<MessageFiles>("", path, false, log);
  if (auto opened = file->add_stream(""); !opened) return opened.error();
  return std::unique_ptr<Format>(std::move(file));
}

Result<std::unique_ptr<Format>> open_folder(const std::string& folder,
                                            const std::vector<std::string>& streams, bool append) {
  const auto place = append ? folder : free_place({Place::Kind::Folder, folder, "", {}}).path;
  std::error_code failed;
  const bool is_new = fs::create_directories(place, failed);
  if (failed) return Error{Code::System, place + ": " + failed.message()};
  auto made = std::make_unique<MessageFiles>(place, "", append, LogSink());
  for (const auto& name : streams)
    if (auto added = made->add_stream(name); !added) {
      // Empty files would send the next attempt to another folder.
      std::error_code ignored;
      for (const auto& each : made->files())
        if (fs::is_empty(each, ignored)) fs::remove(each, ignored);
      if (is_new) fs::remove(place, ignored);
      return added.error();
    }
  return std::unique_ptr<Format>(std::move(made));
}

}  // namespace hc::record
