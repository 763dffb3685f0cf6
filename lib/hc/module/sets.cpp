// SPDX-License-Identifier: Apache-2.0
#include <hc/module/sets.h>

#include <algorithm>

namespace hc {

using internal::Inlet;

bool Module::Sets::is_linked(const internal::InputState& input) const {
  return std::ranges::any_of(inlets_, [&](const Inlet& inlet) {
    return inlet.source != nullptr && std::ranges::count(inlet.inputs, &input) > 0;
  });
}

void Module::Sets::begin(const Inlet& inlet) {
  for (auto* input : inlet.inputs)
    if (input->together != nullptr) input->together->matcher.begin(input->place);
  for (auto& together : module_.together_)
    together->is_latest = std::ranges::any_of(inlets_, [&](const auto& each) {
      return each.is_latest && each.together() == together.get();
    });
}

void Module::Sets::end(const Inlet& inlet) {
  for (auto* input : inlet.inputs)
    if (input->together != nullptr && !is_linked(*input))
      input->together->matcher.end(input->place);
}

void Module::Sets::end_unlinked(bool takes_commands) {
  for (const auto& together : module_.together_) {
    std::string unlinked;
    for (const auto& input : together->inputs) {
      if (is_linked(*input)) continue;
      unlinked = input->name;
      if (!takes_commands) together->matcher.end(input->place);
    }
    for (const auto& input : together->inputs)
      if (!unlinked.empty() && is_linked(*input))
        module_.log(input->name + (takes_commands ? ": waits as long as " : ": not read, since ") +
                    unlinked + " has no link");
  }
}

bool Module::Sets::are_over(const Inlet& inlet) {
  return std::ranges::all_of(inlet.inputs, [](const auto* input) {
    return input->together != nullptr && input->together->matcher.done();
  });
}

void Module::Sets::handle_newest() {
  for (auto& together : module_.together_) {
    if (together->set.empty()) continue;
    const auto inlet = std::ranges::find(inlets_, together.get(), &Inlet::together);
    if (inlet != inlets_.end()) delivery_.handle(*inlet, *together);  // else it was removed
  }
}

void Module::Sets::end_all() {
  for (const auto& together : module_.together_)
    for (const auto& input : together->inputs) together->matcher.end(input->place);
}

void Module::Sets::log_dropped() const {
  for (const auto& together : module_.together_)
    for (const auto& input : together->inputs) {
      const auto& dropped = together->matcher.dropped(input->place);
      if (dropped.total() == 0 || together->is_latest) continue;
      module_.log(input->name + ": dropped " + std::to_string(dropped.unmatched) + " unmatched, " +
                  std::to_string(dropped.crowded) + " on queue overflow");
    }
}

}  // namespace hc
