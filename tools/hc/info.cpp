// SPDX-License-Identifier: Apache-2.0
// hc info: summarises a recording or stream.

#include <map>
#include <optional>
#include <set>

#include <hc/base/format.h>
#include <mcap/link.h>

#include "common.h"
#include "observer.h"
#include "readable.h"
#include "verbs.h"

namespace tool {
namespace {

/// The messages of one src.
struct Sender {
  std::uint64_t messages = 0, bytes = 0;
  std::uint64_t lost = 0, repeated = 0, restarts = 0;
  std::int64_t last_seq = -1, first_time = 0, last_time = 0;
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
    if (header.time != 0 && first_time == 0) first_time = header.time;
    if (header.time != 0) last_time = header.time;
    ++messages;
    bytes += message.elements.size();
  }

  [[nodiscard]] double seconds() const {
    return static_cast<double>(last_time - first_time) * 1e-9;
  }
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
    std::string types;
    for (const auto& type : sender.types) types += (types.empty() ? "" : "; ") + type;
    text += hc::format(
        "{:>6} {:>9} {:>9} {:>9} {:>8} {:>6} {:>10}  {}\n", src, sender.messages,
        bytes_in_words(static_cast<double>(sender.bytes)),
        timed ? hc::format("{:.3f} s", sender.seconds()) : "-",
        timed ? hc::format("{:.3g} Hz", static_cast<double>(sender.messages - 1) / sender.seconds())
              : "-",
        sender.lost, sender.repeated, types);
    if (sender.restarts > 0)
      text += hc::format("{:>6} seq restarted {} time{}\n", "", sender.restarts,
                         sender.restarts == 1 ? "" : "s");
  }
  print(text);
}

/// What the summary of a recording in MCAP says; its messages are not read.
void print_recording(const hc::Uri& uri) {
  auto reader = value_or_fail(hc::mcap::Reader::open(uri.rest), uri.rest);
  const auto summary = value_or_fail(reader.summary(), uri.rest);
  const double seconds = static_cast<double>(summary.end - summary.begin) * 1e-9;
  std::string text = hc::format("{:<32} {:>9} {:>8}  {}\n", "stream", "messages", "rate", "type");
  std::uint64_t messages = 0;
  auto add = [&](const std::string& name, std::uint64_t count, const std::string& type) {
    text += hc::format(
        "{:<32} {:>9} {:>8}  {}\n", name, count,
        seconds > 0 ? hc::format("{:.3g} Hz", static_cast<double>(count) / seconds) : "-", type);
  };
  std::set<std::string> topics;
  for (const auto& stream : hc::mcap::streams(summary)) {
    add(stream.name, stream.messages, stream.type);
    messages += stream.messages;
    topics.insert(stream.topics.begin(), stream.topics.end());
  }
  for (const auto& [id, channel] : summary.channels) {
    if (topics.contains(channel.topic)) continue;
    const auto count = summary.counts.find(id);
    const auto schema = summary.schemas.find(channel.schema);
    add(channel.topic, count == summary.counts.end() ? 0 : count->second,
        schema == summary.schemas.end() ? channel.encoding : schema->second.name);
  }
  text += hc::format("{} message{}, {} in {} chunk{} of {}, {:.3f} s\n", messages,
                     messages == 1 ? "" : "s", bytes_in_words(static_cast<double>(reader.size())),
                     summary.chunks, summary.chunks == 1 ? "" : "s",
                     bytes_in_words(static_cast<double>(summary.plain)), seconds);
  if (summary.metadata > 0)
    text += hc::format("{} records of metadata, such as {}\n", summary.metadata,
                       summary.first_metadata);
  print(text);
  if (!summary.is_whole)
    throw Failure(uri.rest, {hc::Code::Truncated,
                             "the file has no end, as a recorder that was killed leaves it; this "
                             "is what it holds in whole chunks"});
}

void run(const InfoOptions& options) {
  const auto recording = hc::mcap::recording_uri(options.uri);
  if (recording && recording->options.empty() && options.count == 0)
    return print_recording(*recording);
  auto source = open_named(options.uri, options.of, options.limit);
  std::map<std::int32_t, Sender> senders;
  hc::Message message;
  Progress progress("hc info");
  Skipper skipper("hc info");
  std::optional<Failure> fault;
  for (std::uint64_t taken = 0; options.count == 0 || taken < options.count;) {
    try {
      if (!receive(*source, message, options.uri)) break;
    } catch (const Failure& failure) {
      if (options.skip) {
        skipper.skip(*source, failure, options.uri);
        continue;
      }
      fault = failure;
      break;
    }
    skipper.whole_message();
    ++taken;
    senders[message.header.src].add(message);
    auto traffic = source->traffic();
    progress.show(-1, hc::format("{} messages, {}", traffic.messages,
                                 bytes_in_words(static_cast<double>(traffic.bytes))));
  }
  // Also where the end is corrupt.
  print_senders(senders);
  auto traffic = source->traffic();
  print(hc::format("{} message{}, {}\n", traffic.messages, traffic.messages == 1 ? "" : "s",
                   bytes_in_words(static_cast<double>(traffic.bytes))));
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
