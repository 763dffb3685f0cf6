// SPDX-License-Identifier: Apache-2.0
#include "graph_recording.h"

#include "common.h"

namespace tool {

GraphRecording::GraphRecording(const std::string& place)
    : place_(value_or_fail(hc::record::place_of_streams(place))) {
  auto reader = open_recording({place_}, kDefaultLimit);
  for (const auto& stream : value_or_fail(reader->streams(), place)) outputs_.insert(stream.name);
  for (auto& [name, words] : value_or_fail(reader->metadata(), place))
    if (name == "hypercolumn.graph") graph_file_ = words["file"];
}

std::string GraphRecording::place_of(const std::string& output) const {
  auto place = place_;
  place.stream = output;
  return place.text();
}

std::unique_ptr<hc::Source> GraphRecording::open(const std::string& output) const {
  auto place = place_;
  place.stream = output;
  return open_recording({place}, kDefaultLimit);
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
