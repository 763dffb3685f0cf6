// SPDX-License-Identifier: Apache-2.0
#include <mcap/folder_recorder.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace hc::mcap {
namespace {

namespace fs = std::filesystem;

/// A sink has less than that of a stream in memory. [byte]
constexpr std::uint64_t kMostUnwritten = std::uint64_t{1} << 20;

std::string path_of(const std::string& folder, const std::string& stream) {
  return (fs::path(folder) / (stream + ".mtp")).string();
}

/// A folder that has none of the files.
std::string free_folder(const std::string& folder, const std::vector<std::string>& streams) {
  fs::path path(folder);
  if (!path.has_filename()) path = path.parent_path();  // "kept/"
  auto is_free = [&](const std::string& name) {
    std::error_code missing;
    return std::ranges::none_of(
        streams, [&](const auto& stream) { return fs::exists(path_of(name, stream), missing); });
  };
  std::string name = folder;
  for (int i = 2; !is_free(name); ++i) name = path.string() + "_" + std::to_string(i);
  return name;
}

}  // namespace

Result<std::unique_ptr<FolderRecorder>> FolderRecorder::make(
    const std::string& folder, const std::vector<std::string>& streams) {
  std::set<std::string> names;
  for (const auto& name : streams)
    if (name.empty() || name.find('/') != std::string::npos || !names.insert(name).second)
      return Error{Code::Invalid, "streams: each is a file of its name, which \"" + name +
                                      "\" cannot be" + (names.contains(name) ? " twice" : "")};
  std::unique_ptr<FolderRecorder> made(new FolderRecorder(free_folder(folder, streams)));
  std::error_code failed;
  fs::create_directories(made->folder_, failed);
  if (failed) return Error{Code::System, made->folder_ + ": " + failed.message()};
  for (const auto& name : streams) {
    const auto path = path_of(made->folder_, name);
    auto sink = open_sink({"file", path, {}});
    if (!sink) return sink.error();
    made->streams_.push_back({path, std::move(*sink)});
  }
  return made;
}

Status FolderRecorder::record(std::size_t number, const Message& message) {
  ++messages_;
  auto& stream = streams_[number];
  if (stream.sink != nullptr) {
    if (auto sent = stream.sink->send(message)) {
      auto& ends = stream.ends;
      ends.push_back(stream.sink->traffic().bytes);
      while (ends.size() > 1 && ends[1] + kMostUnwritten <= ends.back()) ends.pop_front();
      return {};
    }
    static_cast<void>(close());
  }
  ++lost_;
  return status_;
}

Status FolderRecorder::close() {
  for (auto& stream : streams_)
    if (stream.sink != nullptr) end(stream);
  return status_;
}

/// Small messages are written some time after they were taken, so that others than the last one
/// may be missing when that fails.
void FolderRecorder::end(Stream& stream) {
  const auto closed = stream.sink->close();
  stream.sink.reset();
  if (closed) return;
  if (status_) status_ = Error{closed.error().code, stream.path + ": " + closed.error().detail};
  std::error_code failed;
  const auto size = fs::file_size(stream.path, failed);
  if (failed) return;
  for (; stream.ends.size() > 1 && stream.ends.back() > size; stream.ends.pop_back()) ++lost_;
  if (stream.ends.back() < size) fs::resize_file(stream.path, stream.ends.back(), failed);
}

}  // namespace hc::mcap
