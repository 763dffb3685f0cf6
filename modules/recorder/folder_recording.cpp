// SPDX-License-Identifier: Apache-2.0
#include "folder_recording.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include <hc/contract/recording.h>
#include <hc/module/port.h>
#include <hc/os/new_file.h>

namespace {

namespace fs = std::filesystem;

class FolderRecording : public Recording {
 public:
  explicit FolderRecording(std::string folder) : folder_(std::move(folder)) {}

  /// Before the first message.
  hc::Status add_stream(const std::string& name) {
    const auto path = hc::recording_file(folder_, name);
    auto sink = hc::open_sink({"file", path, {}});
    if (!sink) return sink.error();
    streams_.push_back({path, std::move(*sink)});
    return {};
  }

  hc::Status record(std::size_t number, const hc::Message& message) override {
    ++messages_;
    auto& [path, sink] = streams_[number];
    if (sink != nullptr) {
      auto sent = sink->send(message);
      if (sent) return {};
      status_ = hc::Error{sent.error().code, path + ": " + sent.error().detail};
      static_cast<void>(close());
    }
    ++lost_;
    return status_;
  }

  /// Small messages are written from a buffer, so some that were accepted may be lost if that
  /// fails.
  hc::Status close() override {
    for (auto& [path, sink] : streams_) {
      if (sink == nullptr) continue;
      auto closed = sink->close();
      if (!closed && status_)
        status_ = hc::Error{closed.error().code, path + ": " + closed.error().detail};
      lost_ += sink->traffic().dropped_disconnect;
      sink.reset();
    }
    return status_;
  }

  [[nodiscard]] const std::string& place() const override { return folder_; }
  [[nodiscard]] std::uint64_t messages() const override { return messages_; }
  [[nodiscard]] std::uint64_t lost() const override { return lost_; }

 private:
  struct Stream {
    std::string path;
    std::unique_ptr<hc::Sink> sink;  // null: closed
  };

  const std::string folder_;
  std::vector<Stream> streams_;
  hc::Status status_;
  std::uint64_t messages_ = 0, lost_ = 0;
};

}  // namespace

hc::Result<std::unique_ptr<Recording>> open_folder(const std::string& folder,
                                                   const std::vector<std::string>& streams) {
  std::set<std::string> names;
  for (const auto& name : streams) {
    const bool is_file_name = !name.empty() && name.find('/') == std::string::npos;
    if (is_file_name && names.insert(name).second) continue;
    return hc::Error{
        hc::Code::Invalid,
        "streams: \"" + name + "\" " + (is_file_name ? "is there twice" : "cannot be a file name")};
  }
  const auto place = hc::free_name(folder, "", hc::is_free_for_recording);
  std::error_code failed;
  const bool is_new = fs::create_directories(place, failed);
  if (failed) return hc::Error{hc::Code::System, place + ": " + failed.message()};
  auto made = std::make_unique<FolderRecording>(place);
  for (const auto& name : streams)
    if (auto added = made->add_stream(name); !added) {
      // Empty files would send the next attempt to another folder.
      std::error_code ignored;
      for (const auto& each : streams) fs::remove(hc::recording_file(place, each), ignored);
      if (is_new) fs::remove(place, ignored);
      return added.error();
    }
  return std::unique_ptr<Recording>(std::move(made));
}
