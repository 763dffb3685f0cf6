// SPDX-License-Identifier: Apache-2.0
// hc record: keeps what comes over links in a file.
#include <fmt/format.h>

#include "common.h"
#include "verbs.h"

namespace tool {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> links = {"-"};
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
};

void run(const Options& options) {
  std::vector<std::unique_ptr<hc::Source>> sources;
  for (const auto& link : options.links) sources.push_back(open_source(link, options.limit));
  auto sink = open_sink("file:" + options.file);
  Progress progress("hc record " + options.file);
  hc::Message message;
  while (!sources.empty()) {
    bool any = false;
    for (std::size_t i = 0; i < sources.size();) {
      auto got = value_or_fail(sources[i]->take(message), options.links[i]);
      if (got == hc::Got::End) {
        sources.erase(sources.begin() + static_cast<std::ptrdiff_t>(i));
        continue;
      }
      ++i;
      if (got != hc::Got::Message) continue;
      any = true;
      if (auto sent = sink->send(message); !sent) throw Failure(options.file, sent.error());
      auto traffic = sink->traffic();
      progress.show(-1, fmt::format("{} messages, {}", traffic.messages,
                                    bytes_in_words(static_cast<double>(traffic.bytes))));
      if (traffic.messages == options.count) return;
    }
    if (any || sources.empty()) continue;
    std::vector<int> descriptors;
    for (const auto& source : sources) descriptors.push_back(source->descriptor());
    auto ready = hc::wait_readable(descriptors, stop_descriptor());
    if (!ready) return;  // told to stop: what has come is kept
  }
}

}  // namespace

void add_record(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* verb = app.add_subcommand("record", "Keep what comes over links in a file");
  verb->add_option("file", options->file, "the file, written anew")->required();
  verb->add_option("--in", options->links, "where messages come from; may be repeated");
  verb->add_option("--count", options->count, "end after so many messages");
  verb->add_option("--limit", options->limit, "largest elements that are taken [byte]");
  verb->callback([options] { run(*options); });
}

}  // namespace tool
