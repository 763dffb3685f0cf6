// SPDX-License-Identifier: Apache-2.0
// hc cat: prints messages.

#include <hc/base/format.h>
#include <hc/compress/compress.h>

#include "common.h"
#include "json.h"
#include "readable.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

struct CatOptions {
  std::string uri = "-", of;
  bool json = false, raw = false, skip = false;
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
};

void run(const CatOptions& options) {
  auto source = open_named(options.uri, options.of, options.limit);
  std::unique_ptr<hc::Sink> raw;
  if (options.raw) raw = open_sink("-");
  hc::Message message;
  std::uint64_t damaged = 0;  // messages whose elements cannot be expanded
  for (std::uint64_t shown = 0; options.count == 0 || shown < options.count;) {
    if (!receive(*source, message, options.uri, "hc cat", options.skip)) break;
    auto expanded = options.raw ? hc::Result<hc::Message>(message) : hc::expand(message);
    if (!expanded) {
      if (damaged++ == 0)
        say(hc::format("hc cat: {}", Failure(options.uri, expanded.error()).what()));
      continue;
    }
    // In JSON the header is printed unchanged.
    bool is_read = options.raw    ? send(*raw, message, "-")
                   : options.json ? write_json(*expanded, message.header, print)
                                  : print(to_readable(*expanded));
    if (!is_read) break;
    ++shown;
  }
  if (raw != nullptr) static_cast<void>(raw->close());
  say_losses("hc cat", options.uri, source->traffic());
  if (damaged > 1) say(hc::format("hc cat: skipped {} damaged messages", damaged));
  if (damaged > 0 && !options.skip) throw Failure(1);
}

}  // namespace

void add_cat(CLI::App& app) {
  auto options = std::make_shared<CatOptions>();
  auto* verb = app.add_subcommand("cat", "Print messages of a port, link or file");
  add_source(*verb, options->uri, options->of);
  auto* json = verb->add_flag("--json", options->json, "one JSON object a line");
  verb->add_flag("--raw", options->raw, "the messages themselves")->excludes(json);
  verb->add_flag("--skip", options->skip, "skip corrupt messages (files only)");
  add_count(*verb, options->count);
  add_limit(*verb, options->limit);
  verb->callback([options] { run(*options); });
}

}  // namespace tool
