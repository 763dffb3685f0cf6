// SPDX-License-Identifier: Apache-2.0
// The frames of a graph: a tree, and the text of it that modules get.
#include <algorithm>
#include <sstream>

#include <hc/graph/planning.h>

namespace hc::internal {
namespace {

constexpr const char* kParameter = "frames";

/// Metric frames that have a number. Source: spec/mtp-1.md, R44
const std::map<std::string, std::int64_t> kStandard = {
    {"world", 1},     {"robot", 2},         {"head", 3},       {"left_eye", 4},
    {"right_eye", 5}, {"cyclopean_eye", 6}, {"supervisor", 14}};

class Frames {
 public:
  explicit Frames(Planning& planning) : planning_(planning), graph_(planning.graph) {}

  void run() {
    for (const auto& frame : graph_.frames) by_name_[frame.name] = &frame;
    check_numbers();
    check_tree();
    for (const auto& frame : graph_.frames)
      if (frame.moved_by) check_mover(*frame.moved_by);
    if (!planning_.problems.empty() || graph_.frames.empty()) return;
    const std::string text = text_of_all();
    for (auto& [name, description] : planning_.described) {
      const auto* parameter = find_named(description.parameters, kParameter);
      PlannedModule* planned = planning_.planned(name);
      if (parameter != nullptr && std::holds_alternative<std::string>(parameter->state.value))
        planned->parameters.try_emplace(kParameter, text);
    }
  }

 private:
  void check_numbers() {
    std::map<std::int64_t, std::string> names;
    for (const auto& [name, number] : kStandard) names[number] = name;
    for (const auto& frame : graph_.frames) {
      if (frame.coord.value == 0) continue;
      auto [other, is_new] = names.emplace(frame.coord.value, frame.name);
      if (!is_new && other->second != frame.name)
        planning_.problems.add(
            frame.coord.place,
            "coordinate system " + std::to_string(frame.coord.value) + " is " + other->second);
      auto standard = kStandard.find(frame.name);
      if (standard != kStandard.end() && standard->second != frame.coord.value)
        planning_.problems.add(frame.coord.place, "frame " + frame.name + " has the number " +
                                                      std::to_string(standard->second));
    }
  }

  /// A parent that is no key is the root; there is one.
  void check_tree() {
    std::string root;
    std::vector<std::string> known;
    for (const auto& frame : graph_.frames) known.push_back(frame.name);
    for (const auto& frame : graph_.frames) {
      const std::string& parent = frame.parent.value;
      if (parent.empty() || by_name_.contains(parent)) continue;
      if (root.empty()) root = parent;
      if (parent == root) continue;
      known.push_back(root);
      planning_.problems.add(frame.parent.place, "no frame \"" + parent + "\"" +
                                                     suggest(planning_, parent, known) +
                                                     "; the root is " + root);
      known.pop_back();
    }
    enum class Visit { Begun = 1, Done };
    std::map<std::string, Visit> visits;
    for (const auto& frame : graph_.frames) {
      std::vector<const GraphFrame*> way;
      const GraphFrame* at = &frame;
      while (at != nullptr && !visits.contains(at->name)) {
        visits[at->name] = Visit::Begun;
        way.push_back(at);
        auto parent = by_name_.find(at->parent.value);
        at = parent == by_name_.end() ? nullptr : parent->second;
      }
      if (at != nullptr && visits[at->name] == Visit::Begun) add_circle(way, *at);
      for (const auto* each : way) visits[each->name] = Visit::Done;
    }
  }

  void add_circle(const std::vector<const GraphFrame*>& way, const GraphFrame& first) {
    std::string text = first.name;
    for (auto each = std::find(way.begin(), way.end(), &first); each != way.end(); ++each)
      text += " in " + (*each)->parent.value;
    planning_.problems.add(first.parent.place, "frames form a circle: " + text);
  }

  void check_mover(const Lined<GraphPort>& mover) {
    const GraphPort& port = mover.value;
    if (!planning_.names.contains(port.module))
      return add_no_module(planning_, mover.place, port.module);
    const Description* description = planning_.description_of(port.module);
    if (description != nullptr && find_output(*description, port.port) == nullptr)
      add_no_port(planning_, mover.place, port, "output", description->outputs);
  }

  /// As G36 has it.
  [[nodiscard]] std::string text_of_all() const {
    std::ostringstream text;
    text.precision(17);
    for (const auto& frame : graph_.frames) {
      if (text.tellp() > 0) text << "; ";
      auto standard = kStandard.find(frame.name);
      text << frame.name << " "
           << (standard != kStandard.end() ? standard->second : frame.coord.value) << " "
           << frame.parent.value;
      if (frame.moved_by) {
        text << " " << frame.moved_by->value.text() << " " << address_of(frame.moved_by->value);
        continue;
      }
      for (double length : frame.translation) text << " " << length;
      for (double part : frame.rotation) text << " " << part;
    }
    return text.str();
  }

  /// Of an output, as its module was told.
  [[nodiscard]] std::string address_of(const GraphPort& port) const {
    const auto& options = planning_.planned(port.module)->options;
    for (const auto& option : options)
      if (option.starts_with(port.port + "=")) return option.substr(port.port.size() + 1);
    return "0";
  }

  Planning& planning_;
  const Graph& graph_;
  std::map<std::string, const GraphFrame*> by_name_;
};

}  // namespace

void plan_frames(Planning& planning) {
  Frames(planning).run();
}

}  // namespace hc::internal
