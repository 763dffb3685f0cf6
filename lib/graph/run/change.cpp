// SPDX-License-Identifier: Apache-2.0
#include <graph/run/change.h>

#include <algorithm>

#include <hc/base/uri.h>

namespace hc::internal {
namespace {

using Verb = ModuleCommand::Verb;

const PlannedEnd* find_same(const std::vector<PlannedEnd>& ends, const PlannedEnd& wanted) {
  auto found = std::find_if(ends.begin(), ends.end(),
                            [&](const auto& end) { return is_same_end(end, wanted); });
  return found == ends.end() ? nullptr : &*found;
}

/// A URI without `readers`, which a writer uses only before its first message.
std::string without_readers(const std::string& uri) {
  auto parsed = parse_uri(uri);
  if (!parsed) return uri;
  std::erase_if(parsed->options, [](const auto& option) { return option.first == "readers"; });
  return parsed->text();
}

/// Sets new and changed parameters; resets removed ones by a restart.
void add_settings(const PlannedModule& before, const PlannedModule& after, ModuleChange& change) {
  for (const auto& [key, value] : before.parameters)
    if (!after.parameters.contains(key)) change.needs_restart = true;
  for (const auto& [key, value] : after.parameters) {
    auto found = before.parameters.find(key);
    if (found != before.parameters.end() && found->second == value) continue;
    if (after.is_fixed(key)) change.needs_restart = true;
    change.outputs.push_back({Verb::Set, true, key, value});
  }
}

void add_links(const PlannedModule& before, const PlannedModule& after, ModuleChange& change) {
  for (const auto& end : before.ends)
    if (find_same(after.ends, end) == nullptr)
      change.unlinks.push_back({Verb::Unlink, end.is_input, end.text(), {}});
  for (const auto& end : after.ends) {
    auto& commands = end.is_input ? change.inputs : change.outputs;
    const PlannedEnd* old = find_same(before.ends, end);
    if (old == nullptr) commands.push_back({Verb::Link, end.is_input, end.text(), {}});
    if (end.route != (old == nullptr ? "" : old->route))
      commands.push_back({Verb::Route, end.is_input, (old == nullptr ? end : *old).text(),
                          end.route.empty() ? "to=*" : end.route});
  }
}

}  // namespace

bool is_same_end(const PlannedEnd& one, const PlannedEnd& other) {
  return one.is_input == other.is_input && one.port == other.port &&
         without_readers(one.uri) == without_readers(other.uri);
}

ModuleChange change_between(const PlannedModule& before, const PlannedModule& after) {
  ModuleChange change;
  add_settings(before, after, change);
  add_links(before, after, change);
  if (after.control_uri.empty() && !change.is_empty()) change.needs_restart = true;
  if (before.program != after.program || before.host != after.host ||
      before.options != after.options || before.control_uri != after.control_uri)
    change.needs_restart = true;
  if (change.needs_restart) change.unlinks = change.outputs = change.inputs = {};
  return change;
}

}  // namespace hc::internal
