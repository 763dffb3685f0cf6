// SPDX-License-Identifier: Apache-2.0
// hc cat: shows what comes over a link.
#include <fmt/format.h>

#include <hc/compress/compress.h>

#include "common.h"
#include "json.h"
#include "readable.h"
#include "verbs.h"

namespace tool {
namespace {

struct Options {
  std::string uri = "-";
  bool json = false, raw = false, skip = false;
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
};

/// Shows one message; false when nobody looks any more.
bool show(const Options& options, const hc::Message& message, hc::Sink* raw) {
  if (raw != nullptr) return send(*raw, message);
  auto plain = hc::expand(message);
  if (!plain) throw Failure(options.uri, plain.error());
  if (!options.json) return print(to_readable(*plain));
  // The header as it came, the elements expanded.
  return print(to_json_as(*plain, message.header) + "\n");
}

void run(const Options& options) {
  auto source = open_source(options.uri, options.limit);
  std::unique_ptr<hc::Sink> raw;
  if (options.raw) raw = open_sink("-");
  hc::Message message;
  for (std::uint64_t shown = 0; options.count == 0 || shown < options.count;) {
    try {
      if (!receive(*source, message, options.uri)) break;
      if (!show(options, message, raw.get())) return;
      ++shown;
    } catch (const Failure& failure) {
      if (!options.skip) throw;
      say(fmt::format("hc cat: {}", failure.what()));
      if (auto resumed = source->resume(); !resumed) throw Failure(options.uri, resumed.error());
    }
  }
  if (raw != nullptr) static_cast<void>(raw->close());
}

}  // namespace

void add_cat(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* verb = app.add_subcommand("cat", "Show what comes over a link or stands in a file");
  verb->add_option("link", options->uri, "where messages come from")->capture_default_str();
  auto* json = verb->add_flag("--json", options->json, "one JSON object a line");
  verb->add_flag("--raw", options->raw, "the messages themselves")->excludes(json);
  verb->add_flag("--skip", options->skip, "go on behind what is damaged (files)");
  verb->add_option("--count", options->count, "end after so many messages");
  verb->add_option("--limit", options->limit, "largest elements that are taken [byte]");
  verb->callback([options] { run(*options); });
}

}  // namespace tool
