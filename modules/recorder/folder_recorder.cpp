// SPDX-License-Identifier: Apache-2.0
#include "folder_recorder.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <hc/contract/recording.h>

namespace {

namespace fs = std::filesystem;

/// A folder that has none of the files.
std::string free_folder(const std::string& folder, const std::vector<std::string>& streams) {
  fs::path path(folder);
  if (!path.has_filename()) path = path.parent_path();  // "kept/"
  auto is_free = [&](const std::string& name) {
    std::error_code missing;
    return std::ranges::none_of(streams, [&](const auto& stream) {
      return fs::exists(hc::recording_file(name, stream), missing);
    });
  };
  std::string name = folder;
  for (int i = 2; !is_free(name); ++i) name = path.string() + "_" + std::to_string(i);
  return name;
}

}  // namespace

hc::Result<std::unique_ptr<FolderRecorder>> FolderRecorder::make(
    const std::string& folder, const std::vector<std::string>& streams) {
  std::set<std::string> names;
  for (const auto& name : streams) {
    const bool is_file_name = !name.empty() && name.find('/') == std::string::npos;
    if (is_file_name && names.insert(name).second) continue;
    return hc::Error{
        hc::Code::Invalid,
        "streams: \"" + name + "\" " + (is_file_name ? "is there twice" : "cannot be a file name")};
  }
  std::unique_ptr<FolderRecorder> made(new FolderRecorder(free_folder(folder, streams)));
  std::error_code failed;
  fs::create_directories(made->folder_, failed);
  if (failed) return hc::Error{hc::Code::System, made->folder_ + ": " + failed.message()};
  for (const auto& name : streams) {
    const auto path = hc::recording_file(made->folder_, name);
    auto sink = hc::open_sink({"file", path, {}});
    if (!sink) return sink.error();
    made->streams_.push_back({path, std::move(*sink)});
  }
  return made;
}

hc::Status FolderRecorder::record(std::size_t number, const hc::Message& message) {
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

/// Small messages are written some time after they were taken, so that some that were taken may be
/// missing when that fails.
hc::Status FolderRecorder::close() {
  for (auto& [path, sink] : streams_) {
    if (sink == nullptr) continue;
    auto closed = sink->close();
    if (!closed && status_)
      status_ = hc::Error{closed.error().code, path + ": " + closed.error().detail};
    lost_ += sink->traffic().cut;
    sink.reset();
  }
  return status_;
}
