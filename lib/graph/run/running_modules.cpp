// SPDX-License-Identifier: Apache-2.0
#include <graph/run/running_modules.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace hc::internal {

Supervised* RunningModules::find(const std::string& name) const {
  const auto found = modules_.find(name);
  return found == modules_.end() ? nullptr : found->second.get();
}

Supervised* RunningModules::at(const std::string& end) const {
  return find(end.substr(0, end.find('.')));
}

std::set<Supervised*> RunningModules::cut_off_by(const std::string& name) const {
  std::set<Supervised*> cut_off;
  std::vector<std::string> way = {name};
  auto add = [&](Supervised* neighbour) {
    const auto& plan = neighbour->plan();
    if (plan.control_uri.empty() && plan.name != name && cut_off.insert(neighbour).second)
      way.push_back(plan.name);
  };
  while (!way.empty()) {
    const std::string last = std::move(way.back());
    way.pop_back();
    for (const auto& link : plan_.links) {
      Supervised *from = at(link.from), *to = at(link.to);
      if (from == nullptr || to == nullptr || from == to) continue;
      if (from->plan().name == last) add(to);
      if (to->plan().name == last) add(from);
    }
  }
  return cut_off;
}

bool RunningModules::has_work(const std::string& name) const {
  bool has_writers = false, is_written_to = false, is_read = false;
  for (const auto& link : plan_.links) {
    const Supervised *from = at(link.from), *to = at(link.to);
    if (from == nullptr || to == nullptr || from == to) continue;
    has_writers = has_writers || to->plan().name == name;
    is_written_to = is_written_to || (to->plan().name == name && !from->is_over());
    is_read = is_read || (from->plan().name == name && !to->is_over());
  }
  return has_writers ? is_written_to : is_read;
}

bool RunningModules::have_run() const {
  return std::ranges::all_of(modules_, [](const auto& entry) { return entry.second->has_run(); });
}

bool RunningModules::are_over() const {
  return leaving_.empty() &&
         std::ranges::all_of(modules_, [](const auto& entry) { return entry.second->is_over(); });
}

Supervised& RunningModules::insert(const std::string& name, std::unique_ptr<Supervised> module) {
  return *(modules_[name] = std::move(module));
}

void RunningModules::let_go(const std::string& name) {
  auto module = modules_.extract(name);
  module.mapped()->end();
  leaving_.insert(std::move(module));
}

Supervised* RunningModules::bring_back(const std::string& name) {
  auto back = leaving_.extract(name);
  return back ? modules_.insert(std::move(back)).position->second.get() : nullptr;
}

void RunningModules::forget_left() {
  std::erase_if(leaving_, [](const auto& entry) { return entry.second->is_over(); });
}

}  // namespace hc::internal
