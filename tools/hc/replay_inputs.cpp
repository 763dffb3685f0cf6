// SPDX-License-Identifier: Apache-2.0
#include "replay_inputs.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "common.h"

namespace tool {
namespace {

namespace fs = std::filesystem;
using What = hc::TraceEvent::What;

constexpr std::size_t kStepsAtOnce = 1000;  // per message

/// Whether a link has its messages in another form than its output.
bool changes_messages(hc::Uri uri) {
  const auto conversion = hc::take_conversion(uri);
  return (conversion && !conversion->is_none()) || !uri.option("bandwidth", "").empty();
}

bool is_step(const hc::TraceEvent& event) {
  if (event.what == What::Took) return event.port == kFocus;
  return event.what == What::Began || event.what == What::Set || event.what == What::Read;
}

}  // namespace

RecordedTrace RecordedTrace::read(const GraphRecording& recording, const std::string& module) {
  const auto output = module + "." + hc::kTracePort;
  if (!recording.has(output)) return {};
  RecordedTrace trace;
  bool is_whole = true;
  auto source = recording.open(output);
  hc::Message message;
  for (std::int64_t seq = 0; recording.receive(*source, message, output); ++seq) {
    trace.was_restarted |= message.header.seq < seq;
    is_whole = is_whole && message.header.seq == seq;
    for (auto& event : hc::read_trace(message)) {
      is_whole = is_whole && event.what != What::Lost;
      trace.events.push_back(std::move(event));
    }
  }
  if (!is_whole) trace.events.clear();
  return trace;
}

std::span<const hc::TraceEvent> RecordedTrace::whole() const {
  const auto end = std::find_if(events.rbegin(), events.rend(),
                                [](const auto& event) { return event.what == What::Ended; });
  return {events.begin(), end.base()};
}

std::vector<hc::TraceEvent> RecordedTrace::steps() const {
  std::vector<hc::TraceEvent> steps;
  if (!events.empty()) steps.push_back({What::Took, "", 0, 0, {}, events.front().moment});
  std::ranges::copy_if(whole(), std::back_inserter(steps), is_step);
  for (auto& step : steps)
    if (step.what == What::Took && !step.port.empty()) step.what = What::Began;  // the focus
  return steps;
}

std::span<const hc::TraceEvent> RecordedTrace::before(const hc::TraceEvent& step) const {
  const auto end = std::ranges::find_if(events, [&](const auto& each) {
    return is_step(each) && each.port == step.port && each.number == step.number &&
           each.moment == step.moment && each.key() == step.key();
  });
  return {events.begin(), end};
}

void Feed::add(std::int64_t seq, hc::Uri uri) {
  auto conversion = value_or_fail(hc::take_conversion(uri), output);
  if (!uri.option("bandwidth", "").empty())
    hindrance =
        "images from " + output + " were adapted to a bandwidth, and recorded as they were before";
  conversions.insert_or_assign(seq, std::move(conversion));
}

void Feed::add_changes(const RecordedTrace& trace, const std::string& reader) {
  std::int64_t sent = 0;
  bool is_numbered = true;
  for (const auto& event : trace.events) {
    if (event.port != output.substr(output.find('.') + 1)) continue;
    // A router passes on the numbers of others.
    if (event.what == What::Sent) is_numbered = is_numbered && event.seq == sent++;
    if (event.what != What::Linked && event.what != What::Unlinked) continue;
    auto uri = hc::parse_uri(event.value);
    if (!uri) continue;
    // A link that changes messages does not share its end, whose name has both ports (link_plan).
    const bool is_named = uri->rest.find("." + output + ".") != std::string::npos;
    if (is_named ? !uri->rest.ends_with("." + output + "." + reader) : !changes_messages(*uri))
      continue;
    if (!is_named || trace.was_restarted || !is_numbered) {
      hindrance = "the form of messages from " + output + " was changed while it was recorded";
      return;
    }
    add(event.seq, event.what == What::Linked ? *uri : hc::Uri());
  }
}

template <typename IsWanted>
void Feed::write(const GraphRecording& recording, const fs::path& to,
                 const IsWanted& is_wanted) const {
  auto source = recording.open(output);
  auto sink = open_file_sink(to);
  hc::Message message;
  const auto conversion_of = [&](const hc::Message& sent) {
    const auto after = conversions.upper_bound(sent.header.seq);
    return after == conversions.begin() ? hc::Conversion() : std::prev(after)->second;
  };
  while (recording.receive(*source, message, output))
    if (is_wanted(message.header) &&
        !send(*sink, value_or_fail(hc::convert(message, conversion_of(message)), output), to))
      return;
  if (auto closed = sink->close(); !closed) throw Failure(to.string(), closed.error());
}

void Feed::write_all(const GraphRecording& recording, const fs::path& to) const {
  write(recording, to, [](const hc::Header&) { return true; });
}

std::optional<hc::TraceEvent> Feed::write_handled(const GraphRecording& recording,
                                                  std::vector<hc::TraceEvent>& steps,
                                                  const fs::path& to) const {
  const auto is_of_link = [&](const auto& step) {
    return step.what == What::Began && step.port == port && step.number == number;
  };
  std::set<hc::MessageKey> handled, found;
  for (const auto& step : steps)
    if (is_of_link(step)) handled.insert(step.key());
  write(recording, to, [&](const hc::Header& header) {
    const auto key = hc::MessageKey::of(header);
    return handled.contains(key) && found.insert(key).second;
  });
  const auto is_found = [&](const auto& step) {
    return is_of_link(step) && found.contains(step.key());
  };
  const auto is_missing = [&](const auto& step) {
    return is_of_link(step) && !found.contains(step.key());
  };
  const auto first = std::ranges::find_if(steps, is_found);
  const auto missing = std::find_if(first, steps.end(), is_missing);
  auto result = missing == steps.end() ? std::nullopt : std::optional(*missing);
  steps.erase(missing, steps.end());
  std::erase_if(steps, is_missing);
  return result;
}

void write_steps(const std::vector<hc::TraceEvent>& steps, const fs::path& to) {
  auto sink = open_file_sink(to);
  for (std::size_t i = 0; i < steps.size(); i += kStepsAtOnce) {
    const auto some = std::span(steps).subspan(i, std::min(kStepsAtOnce, steps.size() - i));
    if (!send(*sink, hc::make_trace(some), to)) return;
  }
  if (auto closed = sink->close(); !closed) throw Failure(to.string(), closed.error());
}

}  // namespace tool
