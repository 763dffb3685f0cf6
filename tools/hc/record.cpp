// SPDX-License-Identifier: Apache-2.0
// hc record: records ports or links to a file.

#include <array>
#include <filesystem>

#include <hc/base/format.h>
#include <hc/link/wait_set.h>
#include <hc/os/program.h>

#include "common.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

struct RecordOptions {
  std::string file, of;
  std::vector<std::string> links;
  std::uint64_t count = 0;
  std::uint64_t limit = kDefaultLimit;
};

/// Whether a link is the file that is to be written.
bool is_file(const std::string& link, const std::string& file) {
  std::error_code missing;
  auto uri = hc::parse_uri(link);
  if (!uri || (uri->scheme != "file" && uri->scheme != "-")) return false;
  std::string path = uri->scheme == "-" ? "/proc/self/fd/0" : uri->rest;
  return std::filesystem::is_regular_file(path, missing) &&
         std::filesystem::equivalent(path, file, missing);
}

struct Link {
  std::string uri;
  std::unique_ptr<hc::Source> source;  // null once it has ended
};

/// Takes the words SOURCE FILE, or FILE alone, as `file` is empty then.
void take_words(const std::string& source, const std::string& file, RecordOptions& options) {
  options.file = file.empty() ? source : file;
  if (!file.empty()) options.links.insert(options.links.begin(), source);
  if (!options.links.empty()) return;
  if (is_running_port(options.file, options.of))
    throw Failure({hc::Code::Invalid,
                   hc::format("{} is a port of a running graph: give a FILE behind it to record "
                              "it, or ./{} for a file of that name",
                              options.file, options.file)});
  options.links = {"-"};
}

void run(const RecordOptions& options) {
  std::vector<std::string> uris;  // all before the first link is opened
  for (const auto& uri : options.links) {
    if (is_file(uri, options.file))
      throw Failure(hc::Error{hc::Code::Invalid, uri + " is the file that is written"});
    uris.push_back(source_uri(uri, options.of));
  }
  std::vector<Link> links;
  for (std::size_t i = 0; i < uris.size(); ++i)
    links.push_back({options.links[i], open_source(uris[i], options.limit)});
  auto sink = open_file_sink(options.file);
  Progress progress("hc record " + options.file);
  hc::Message message;
  hc::WaitSet waits(hc::stop_descriptor());
  while (!hc::stop_requested()) {  // what has arrived is kept
    bool any = false;
    std::vector<hc::Source*> open;
    for (auto& [uri, source] : links) {
      if (source == nullptr) continue;
      auto got = value_or_fail(source->take(message), uri);
      if (got == hc::Got::End) {
        say_losses("hc record", uri, source->traffic());
        source.reset();
      } else {
        open.push_back(source.get());
      }
      if (got != hc::Got::Message) continue;
      any = true;
      if (auto sent = sink->send(message); !sent) throw Failure(options.file, sent.error());
      auto traffic = sink->traffic();
      progress.show(-1, hc::format("{} messages, {}", traffic.messages,
                                   bytes_in_words(static_cast<double>(traffic.bytes))));
      if (traffic.messages == options.count) return;
    }
    if (open.empty()) return;
    if (!any) static_cast<void>(waits.wait(open));
  }
  for (const auto& [uri, source] : links)
    if (source != nullptr) say_losses("hc record", uri, source->traffic());
}

}  // namespace

void add_record(CLI::App& app) {
  auto options = std::make_shared<RecordOptions>();
  auto* verb = app.add_subcommand("record", "Record ports or links to a file");
  auto words = std::make_shared<std::array<std::string, 2>>();
  verb->add_option("source", words->front(),
                   "what is recorded, as --in has it; where no word follows, the output file")
      ->required();
  verb->add_option("file", words->back(), "output file (overwritten)");
  verb->add_option("--in", options->links,
                   "URIs, files or MODULE.PORT of a running graph; may be repeated")
      ->allow_extra_args(false);
  add_of(*verb, options->of);
  add_count(*verb, options->count);
  add_limit(*verb, options->limit);
  verb->callback([options, words] {
    take_words(words->front(), words->back(), *options);
    run(*options);
  });
}

}  // namespace tool
