// SPDX-License-Identifier: Apache-2.0
#include "graph.h"

#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hosts/hosts.h>

#include "common.h"

namespace tool {

void add_graph_options(CLI::App& verb, hc::LoadOptions& options) {
  options.token = hc::graph_token();
  verb.add_option("graph", options.file, "a graph file (TOML), or the name of a shipped one")
      ->required()
      ->transform(find_graph);
  verb.add_option("--set", options.settings, "MODULE.PARAMETER=VALUE; may be repeated")
      ->allow_extra_args(false);
}

std::unique_ptr<hc::Hosts> make_hosts() {
  return value_or_fail(hc::hosts::make_hosts(HC_VERSION), "the key of this host");
}

hc::LoadedGraph without_problems(std::string_view verb, const std::string& file,
                                 hc::Result<hc::LoadedGraph> loaded) {
  if (!loaded && loaded.error().code == hc::Code::NotFound) {
    const auto& detail = loaded.error().detail;
    if (!detail.starts_with(file + ":")) throw Failure(loaded.error());  // of one that it includes
    const auto meant = hc::suggestion(file, shipped_graphs());
    throw Failure(
        loaded.error().code,
        detail + (meant.empty() ? "; shipped graphs: " + joined(shipped_graphs()) : meant));
  }
  if (!loaded) throw Failure(loaded.error());
  if (loaded->plan) return std::move(*loaded);
  for (const auto& line : loaded->problems) say(hc::format("hc {}: error: {}", verb, line));
  throw Failure(2);
}

hc::Plan load_plan(std::string_view verb, const hc::LoadOptions& options, hc::Hosts* hosts) {
  hc::LoadOptions with_hosts = options;
  with_hosts.hosts = hosts;
  auto loaded = hc::make_loader(with_hosts)->load(nullptr, -1);
  return std::move(*without_problems(verb, options.file, std::move(loaded)).plan);
}

hc::Plan look_at_plan(std::string_view verb, const hc::LoadOptions& options) {
  hc::LoadOptions here = options;
  here.programs_here = true;
  auto loaded = hc::make_loader(here)->load(nullptr, -1);
  // A program that is only on its host is described there.
  if (loaded && !loaded->plan && !loaded->graph.hosts.empty())
    return load_plan(verb, options, make_hosts().get());
  return std::move(*without_problems(verb, options.file, std::move(loaded)).plan);
}

}  // namespace tool
