// SPDX-License-Identifier: Apache-2.0
// hc info: summarises a recording or stream.

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include <hc/base/format.h>
#include <record/reader.h>

#include "common.h"
#include "readable.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

/// Statistics of the messages of one src.
struct Sender {
  std::uint64_t messages = 0, bytes = 0;
  std::uint64_t lost = 0, repeated = 0, restarts = 0;
  std::int64_t last_seq = -1;
  hc::Time first_time, last_time;
  std::set<std::string> types;

  void add(const hc::Message& message) {
    const hc::Header& header = message.header;
    constexpr std::size_t kMostTypes = 8;
    if (types.size() < kMostTypes)
      types.insert(hc::format("{}, {}", matrix_text(header.info, header.width, header.height),
                              name(header.info.encoding)));
    if (last_seq >= 0) {  // R41
      if (header.seq > last_seq + 1) lost += static_cast<std::uint64_t>(header.seq - last_seq - 1);
      if (header.seq == last_seq) ++repeated;
      if (header.seq < last_seq) ++restarts;
    }
    last_seq = header.seq;
    if (header.time != hc::Time()) last_time = header.time;
    if (first_time == hc::Time()) first_time = last_time;
    ++messages;
    bytes += message.elements.size();
  }

  [[nodiscard]] double seconds() const { return hc::seconds(last_time - first_time); }
};

struct InfoOptions {
  std::string uri = "-", of;
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
  bool skip = false;
};

void print_senders(const std::map<std::int32_t, Sender>& senders) {
  std::string text =
      hc::format("{:>6} {:>9} {:>9} {:>9} {:>8} {:>6} {:>10}  {}\n", "src", "messages", "elements",
                 "duration", "rate", "lost", "duplicates", "matrices");
  for (const auto& [src, sender] : senders) {
    bool timed = sender.seconds() > 0;
    const auto types = joined({sender.types.begin(), sender.types.end()}, "; ");
    text += hc::format(
        "{:>6} {:>9} {:>9} {:>9} {:>8} {:>6} {:>10}  {}\n", src, sender.messages,
        bytes_in_words(sender.bytes), timed ? hc::format("{:.3f} s", sender.seconds()) : "-",
        timed ? hc::format("{:.3g} Hz", static_cast<double>(sender.messages - 1) / sender.seconds())
              : "-",
        sender.lost, sender.repeated, types);
    if (sender.restarts > 0)
      text += hc::format("{:>6} seq restarted {}\n", "", counted(sender.restarts, "time"));
  }
  print(text);
}

/// The rate of a stream over its own time; at least that over all streams' time, where only this is
/// known. @param seconds  of all streams
std::string rate_of(const hc::record::StreamInfo& stream, double seconds) {
  const bool has_times = stream.begin != hc::Time();
  const double time = has_times ? hc::seconds(stream.end - stream.begin) : seconds;
  if (time <= 0 || stream.messages < 2) return "-";
  const double rate = static_cast<double>(stream.messages - 1) / time;
  return hc::format("{}{:.3g} Hz", has_times ? "" : ">=", rate);
}

/// Prints the streams of a recording, and other topics. @param seconds  of all streams
void print_streams(const std::vector<hc::record::StreamInfo>& streams, double seconds,
                   const std::string& size) {
  std::string text = hc::format("{:<32} {:>9} {:>8}  {}\n", "stream", "messages", "rate", "type");
  std::uint64_t messages = 0;
  for (const auto& each : streams) {
    text += hc::format("{:<32} {:>9} {:>8}  {}\n", each.name, each.messages, rate_of(each, seconds),
                       each.type);
    messages += each.messages;
  }
  print(text + hc::format("{}, {}, {:.3f} s\n", counted(messages, "message"), size, seconds));
}

void print_folder(const hc::record::Place& place, std::uint64_t limit) {
  const auto streams = value_or_fail(
      open_recording({place}, limit)->streams(hc::record::StreamDetail::Counts), place.text());
  hc::Time begin, end;
  std::uintmax_t size = 0;
  for (const auto& each : streams) {
    if (each.begin != hc::Time())
      begin = begin == hc::Time() ? each.begin : std::min(begin, each.begin);
    end = std::max(end, each.end);
    std::error_code missing;
    size += std::filesystem::file_size(hc::record::stream_file(place.path, each.name), missing);
  }
  print_streams(streams, hc::seconds(end - begin), bytes_in_words(size));
  bool is_whole = true;
  for (const auto& each : streams) {
    if (each.status) continue;
    is_whole = false;
    const Failure failure(hc::record::stream_file(place.path, each.name), each.status.error());
    say(hc::format("hc info: {}", failure.what()));
  }
  if (!is_whole) throw Failure(1);
}

/// Prints the summary of any MCAP file, without reading its messages.
void print_mcap(const std::string& path) {
  auto reader = value_or_fail(hc::mcap::Reader::open(path), path);
  const auto& summary = reader.summary();
  auto streams = hc::record::streams_of(summary);
  std::set<std::uint16_t> shown;
  for (const auto& stream : streams) shown.insert(stream.channels.begin(), stream.channels.end());
  for (const auto& [id, channel] : summary.channels) {
    if (shown.contains(id)) continue;
    const auto count = summary.counts.find(id);
    const auto schema = summary.schemas.find(channel.schema);
    const auto messages = count == summary.counts.end() ? 0 : count->second;
    const auto& type = schema == summary.schemas.end() ? channel.encoding : schema->second.name;
    streams.push_back({channel.topic, type, messages, {}, {}, {}});
  }
  print_streams(streams, static_cast<double>(summary.end - summary.begin) * 1e-9,
                hc::format("{} in {} of {}", bytes_in_words(reader.size()),
                           counted(summary.chunks, "chunk"), bytes_in_words(summary.plain)));
  if (!summary.metadata.empty())
    print(hc::format("{} records of metadata, such as {}\n", summary.metadata.size(),
                     summary.metadata.front()));
  if (summary.unread > 0)
    say(hc::format("hc info: {}: {} of {} chunks have no index, and cannot be read: {}", path,
                   summary.unread, summary.chunks, summary.why_unread));
  if (!summary.is_whole)
    throw Failure(path, {hc::Code::Truncated,
                         "the file is truncated, as after a crash; only complete chunks are "
                         "shown"});
  if (summary.unread > 0) throw Failure(1);
}

void run(const InfoOptions& options) {
  using Kind = hc::record::Place::Kind;
  const auto place = value_or_fail(hc::record::place_of(options.uri));
  const bool is_whole = place.stream.empty() && options.count == 0 && !options.skip &&
                        !graph_of_port(options.uri, options.of);
  if (is_whole && place.kind == Kind::Mcap) return print_mcap(place.path);
  if (is_whole && place.kind == Kind::Folder) return print_folder(place, options.limit);
  auto source = open_named(options.uri, options.of, options.limit);
  std::map<std::int32_t, Sender> senders;
  hc::Message message;
  Progress progress("hc info");
  std::optional<Failure> fault;
  for (std::uint64_t taken = 0; options.count == 0 || taken < options.count; ++taken) {
    try {
      if (!receive(*source, message, options.uri, "hc info", options.skip)) break;
    } catch (const Failure& failure) {
      fault = failure;
      break;
    }
    senders[message.header.src].add(message);
    auto traffic = source->traffic();
    progress.show(-1,
                  hc::format("{} messages, {}", traffic.messages, bytes_in_words(traffic.bytes)));
  }
  // Also after a fault.
  print_senders(senders);
  auto traffic = source->traffic();
  print(
      hc::format("{}, {}\n", counted(traffic.messages, "message"), bytes_in_words(traffic.bytes)));
  say_losses("hc info", options.uri, traffic);
  if (fault) throw Failure(*fault);
}

}  // namespace

void add_info(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  auto* verb = app.add_subcommand("info", "Summarise a recording, port or stream");
  add_source(*verb, options->uri, options->of);
  verb->add_flag("--skip", options->skip, "skip corrupt messages (files only)");
  add_count(*verb, options->count);
  add_limit(*verb, options->limit);
  verb->callback([options] { run(*options); });
}

}  // namespace tool
