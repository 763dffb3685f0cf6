// SPDX-License-Identifier: Apache-2.0
#include "graph.h"

#include <hc/base/format.h>
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

hc::LoadedGraph load_graph(std::string_view verb, hc::GraphLoader& loader) {
  auto loaded = loader.load(nullptr, -1);
  if (!loaded && loaded.error().code == hc::Code::NotFound)
    throw Failure(loaded.error().code,
                  loaded.error().detail + "; shipped graphs: " + joined(shipped_graphs()));
  if (!loaded) throw Failure(loaded.error());
  if (loaded->plan) return std::move(*loaded);
  for (const auto& line : loaded->problems) say(hc::format("hc {}: error: {}", verb, line));
  throw Failure(2);
}

hc::Plan load_plan(std::string_view verb, const hc::LoadOptions& options, hc::Hosts* hosts) {
  const auto own = hosts == nullptr ? make_hosts() : nullptr;
  hc::LoadOptions with_hosts = options;
  with_hosts.hosts = hosts == nullptr ? own.get() : hosts;
  return std::move(*load_graph(verb, *hc::make_loader(with_hosts)).plan);
}

}  // namespace tool
