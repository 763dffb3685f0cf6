// SPDX-License-Identifier: Apache-2.0
#include "graph_recording.h"

#include <filesystem>

#include <hc/contract/recording.h>
#include <mcap/link.h>

#include "common.h"

namespace tool {
namespace {

namespace fs = std::filesystem;

std::set<std::string> streams_of(const std::string& file) {
  auto reader = value_or_fail(hc::mcap::Reader::open(file), file);
  const auto summary = value_or_fail(reader.summary(), file);
  std::set<std::string> names;
  for (const auto& stream : hc::mcap::streams(summary)) names.insert(stream.name);
  return names;
}

std::set<std::string> files_of(const std::string& folder) {
  std::set<std::string> names;
  std::error_code failed;
  fs::directory_iterator each(folder, failed);
  for (; !failed && each != fs::directory_iterator(); each.increment(failed))
    if (each->path().extension() == ".mtp") names.insert(each->path().stem().string());
  if (failed) throw Failure({hc::Code::NotFound, folder + ": " + failed.message()});
  return names;
}

}  // namespace

GraphRecording::GraphRecording(std::string place)
    : place_(std::move(place)),
      is_mcap_(place_.ends_with(".mcap")),
      outputs_(is_mcap_ ? streams_of(place_) : files_of(place_)) {}

std::string GraphRecording::place_of(const std::string& output) const {
  return is_mcap_ ? place_ + "?stream=" + output : hc::recording_file(place_, output);
}

std::string GraphRecording::graph_file() const {
  if (!is_mcap_) return "";
  auto reader = value_or_fail(hc::mcap::Reader::open(place_), place_);
  const auto words = value_or_fail(reader.metadata("hypercolumn.graph"), place_);
  const auto file = words ? words->find("file") : hc::mcap::Words::const_iterator();
  return words && file != words->end() ? file->second : "";
}

std::unique_ptr<hc::Source> GraphRecording::open(const std::string& output) const {
  if (!is_mcap_) return open_file_source(place_of(output), kDefaultLimit);
  hc::LinkOptions options;
  options.limits.element_bytes = kDefaultLimit;
  return value_or_fail(hc::mcap::read_recording({"file", place_, {{"stream", output}}}, options),
                       place_);
}

bool GraphRecording::receive(hc::Source& source, hc::Message& message,
                             const std::string& output) const {
  try {
    return tool::receive(source, message, place_of(output));
  } catch (const Failure& failure) {
    if (failure.code != hc::Code::Truncated) throw;
    return false;
  }
}

}  // namespace tool
