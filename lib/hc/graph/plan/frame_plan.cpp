// SPDX-License-Identifier: Apache-2.0
// The frames of a graph: a tree, and the text of it that modules get.
#include <algorithm>
#include <sstream>

#include <hc/graph/plan/planning.h>

namespace hc::internal {
namespace {

constexpr const char* kFrames = "frames";  // the parameter, and the input

/// Of links to an input `frames`: who is slow must not keep from moving what moves. So many poses
/// are four seconds of a source of 250 Hz.
constexpr const char* kKeep = "1024";

/// Metric frames that have a number. Source: spec/mtp-1.md, R44
const std::map<std::string, std::int64_t> kStandard = {
    {"world", 1},     {"robot", 2},         {"head", 3},       {"left_eye", 4},
    {"right_eye", 5}, {"cyclopean_eye", 6}, {"supervisor", 14}};

class Frames {
 public:
  explicit Frames(Planning& planning) : planning_(planning), graph_(planning.graph) {}

  void run() {
    for (const auto& frame : graph_.frames) by_name_[frame.name] = &frame;
    find_scopes();
    check_numbers();
    check_tree();
    for (const auto& frame : graph_.frames)
      if (frame.moved_by) check_mover(*frame.moved_by);
    check_numbers_of_moved();
    if (!planning_.problems.empty() || graph_.frames.empty()) return;
    planning_.plan.frames = text_for("");
    for (const auto& [name, description] : planning_.described)
      if (takes_frames(planning_, name))
        planning_.planned(name)->parameters.try_emplace(kFrames, text_for(name));
  }

 private:
  void check_numbers() {
    std::map<std::int64_t, std::string> names;
    for (const auto& [name, number] : kStandard) names[number] = name;
    for (const auto& frame : graph_.frames) {
      if (frame.coord.value == 0) continue;
      auto [other, is_new] = names.emplace(frame.coord.value, frame.name);
      auto standard = kStandard.find(frame.name);
      if (standard != kStandard.end() && standard->second != frame.coord.value)
        planning_.problems.add(frame.coord.place, "frame " + frame.name + " has the number " +
                                                      std::to_string(standard->second));
      else if (!is_new && other->second != frame.name)
        planning_.problems.add(
            frame.coord.place,
            "coordinate system " + std::to_string(frame.coord.value) + " is " + other->second);
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
    if (description == nullptr) return;
    const PortDescription* output = find_named(description->outputs, port.port);
    if (output == nullptr)
      return add_no_port(planning_, mover.place, port, "output", description->outputs);
    auto is_pose = [](const PortType& type) {
      return type.info.type == MatrixType::Transformation && type.info.components == 1 &&
             (type.width == 0 || type.width == 4) && (type.height == 0 || type.height == 4);
    };
    if (planning_.problems.empty() && !output->types.empty() && !is_pose(output->types.front()))
      planning_.problems.add(mover.place, port.text() + " sends " + in_words(output->types) +
                                              ", not a pose, transformation 4 x 4");
  }

  /// Of frames that one output moves, its messages tell which is meant by their numbers.
  void check_numbers_of_moved() {
    std::map<std::string, const GraphFrame*> unnumbered;
    for (const auto& frame : graph_.frames) {
      if (!frame.moved_by || (number_of(frame.name) != 0 && number_of(frame.parent.value) != 0))
        continue;
      auto [other, is_new] = unnumbered.emplace(frame.moved_by->value.text(), &frame);
      if (!is_new)
        planning_.problems.add(frame.moved_by->place,
                               frame.moved_by->value.text() + " moves " + other->second->name +
                                   " and " + frame.name +
                                   ", so they and their parents need a \"coord\"");
    }
  }

  [[nodiscard]] std::int64_t number_of(const std::string& name) const {
    if (auto standard = kStandard.find(name); standard != kStandard.end()) return standard->second;
    auto frame = by_name_.find(name);
    return frame == by_name_.end() ? 0 : frame->second->coord.value;
  }

  /// What inclusion has put before the names of a file, "head_", by its standard frames.
  void find_scopes() {
    for (const auto& frame : graph_.frames)
      for (const auto& [standard, number] : kStandard)
        if (frame.place.file != 0 && frame.name.ends_with("_" + standard))
          scopes_[frame.place.file] = frame.name.substr(0, frame.name.size() - standard.size());
  }
  /// A frame's scope; empty: none.
  [[nodiscard]] std::string scope_of(const GraphFrame& frame) const {
    auto scope = scopes_.find(frame.place.file);
    return scope != scopes_.end() && frame.name.starts_with(scope->second) ? scope->second : "";
  }

  /// The names of frames as a module sees them, by those that they have here. What its own graph
  /// file declares has no prefix; nor has a standard frame of another file, if it is the only one.
  [[nodiscard]] std::map<std::string, std::string> names_for(const std::string& module) const {
    std::map<std::string, int> uses;  // of a name without prefix
    for (const auto& frame : graph_.frames) ++uses[frame.name.substr(scope_of(frame).size())];
    std::map<std::string, std::string> names;
    for (const auto& frame : graph_.frames) {
      const std::string scope = scope_of(frame), local = frame.name.substr(scope.size());
      const bool is_own = module.starts_with(scope);
      const bool is_only = kStandard.contains(local) && uses[local] == 1;
      const bool is_free = scope.empty() || !by_name_.contains(local);
      names[frame.name] = is_free && (is_own || is_only) ? local : frame.name;
    }
    return names;
  }

  /// As G31 has it.
  [[nodiscard]] std::string text_for(const std::string& module) const {
    const auto names = names_for(module);
    auto name_of = [&](const std::string& name) {
      auto seen = names.find(name);
      return seen == names.end() ? name : seen->second;
    };
    std::ostringstream text;
    text.precision(17);
    for (const auto& frame : graph_.frames) {
      if (text.tellp() > 0) text << "; ";
      const std::string name = name_of(frame.name);
      text << name << " " << (kStandard.contains(name) ? kStandard.at(name) : number_of(frame.name))
           << " " << name_of(frame.parent.value);
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
  std::map<int, std::string> scopes_;  // by the number of the file
};

}  // namespace

bool takes_frames(const Planning& planning, const std::string& module) {
  const Description* description = planning.description_of(module);
  if (description == nullptr) return false;
  const auto* parameter = find_named(description->parameters, kFrames);
  return parameter != nullptr && std::holds_alternative<std::string>(parameter->value);
}

void link_frames(Planning& planning) {
  std::vector<Lined<GraphPort>> movers;  // each once, in the order of the file
  for (const auto& frame : planning.graph.frames) {
    if (!frame.moved_by) continue;
    const GraphPort& port = frame.moved_by->value;
    const Description* description = planning.description_of(port.module);
    const bool is_there =
        description != nullptr && find_named(description->outputs, port.port) != nullptr;
    auto is_it = [&](const auto& each) { return each.value.text() == port.text(); };
    if (is_there && std::none_of(movers.begin(), movers.end(), is_it))
      movers.push_back(*frame.moved_by);
  }
  std::vector<GraphLink> made;
  for (const auto& module : planning.graph.modules) {
    if (!takes_frames(planning, module.name) || module.parameters.contains(kFrames)) continue;
    if (find_input(*planning.description_of(module.name), kFrames) == nullptr) continue;
    GraphLink link;
    link.to = {module.name, kFrames, {}};
    link.policy["keep"] = {kKeep, {}};
    bool is_linked =
        std::any_of(planning.graph.links.begin(), planning.graph.links.end(),
                    [&](const auto& each) { return each.to.text() == link.to.text(); });
    if (is_linked) continue;
    for (const auto& mover : movers) {
      if (mover.value.module == module.name) continue;
      link.from = mover.value;
      link.place = mover.place;
      made.push_back(link);
    }
  }
  planning.graph.links.insert(planning.graph.links.end(), made.begin(), made.end());
}

void plan_frames(Planning& planning) {
  Frames(planning).run();
}

}  // namespace hc::internal
