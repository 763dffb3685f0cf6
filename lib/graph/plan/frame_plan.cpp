// SPDX-License-Identifier: Apache-2.0
// Checks the tree of frames of a graph, and writes it as text for modules.
#include <algorithm>
#include <sstream>

#include <graph/plan/planning.h>
#include <hc/base/format.h>

namespace hc::internal {
namespace {

constexpr const char* kFrames = "frames";  // parameter and input

/// `keep` of links to an input `frames`, so that a slow reader does not block the source: 4 s of
/// poses at 250 Hz.
constexpr const char* kKeep = "1024";

/// Numbers of metric frames. Source: spec/mtp-1.md, R44
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
    check_numbers_of_moved();
    if (!planning_.problems.empty() || graph_.frames.empty()) return;
    planning_.plan.frames = text_for(0, {});
    for (const auto& module : graph_.modules)
      if (takes_frames(planning_, module.name))
        planning_.planned(module.name)
            ->parameters.try_emplace(kFrames, text_for(module.place.file, module.prefix));
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
        planning_.problems.add(frame.coord.place, "frame {} has the number {}", frame.name,
                               standard->second);
      else if (!is_new && other->second != frame.name)
        planning_.problems.add(frame.coord.place, "coordinate system {} is {}", frame.coord.value,
                               other->second);
    }
  }

  /// A parent that is not declared is the root; there must be one root.
  void check_tree() {
    std::string root;
    auto known = names_of(graph_.frames);
    for (const auto& frame : graph_.frames) {
      const std::string& parent = frame.parent.value;
      if (parent.empty() || by_name_.contains(parent)) continue;
      if (root.empty()) root = parent;
      if (parent == root) continue;
      known.push_back(root);
      planning_.problems.add(frame.parent.place, "no frame \"{}\"{}; the root is {}", parent,
                             suggest(planning_, parent, known), root);
      known.pop_back();
    }
    std::map<const GraphFrame*, const GraphFrame*> met;  // by ancestor: the frame it was met from
    for (const auto& frame : graph_.frames) {
      const GraphFrame* at = &frame;
      while (at != nullptr && met.emplace(at, &frame).second) at = parent_of(*at);
      if (at == nullptr || met.at(at) != &frame) continue;
      std::string circle = at->name;
      const GraphFrame* next = at;
      do {
        circle += " in " + next->parent.value;
        next = parent_of(*next);
      } while (next != at);
      planning_.problems.add(at->parent.place, "frames form a circle: " + circle);
    }
  }

  /// Null if it is the root.
  [[nodiscard]] const GraphFrame* parent_of(const GraphFrame& frame) const {
    auto parent = by_name_.find(frame.parent.value);
    return parent == by_name_.end() ? nullptr : parent->second;
  }

  void check_mover(const Lined<GraphPort>& mover) {
    const PortDescription* output = find_port(planning_, mover.place, mover.value, false);
    if (output == nullptr) return;
    auto is_pose = [](const PortType& type) {
      return type.info.type == MatrixType::Transformation && type.info.components == 1 &&
             (type.width == 0 || type.width == 4) && (type.height == 0 || type.height == 4);
    };
    if (planning_.problems.empty() && !output->types.empty() && !is_pose(output->types.front()))
      planning_.problems.add(mover.place, "{} sends {}, not a pose, transformation 4 x 4",
                             mover.value.text(), in_words(output->types));
  }

  /// If an output moves several frames, its messages identify them by number.
  void check_numbers_of_moved() {
    std::map<std::string, const GraphFrame*> unnumbered;
    for (const auto& frame : graph_.frames) {
      if (!frame.moved_by || (number_of(frame.name) != 0 && number_of(frame.parent.value) != 0))
        continue;
      auto [other, is_new] = unnumbered.emplace(frame.moved_by->value.text(), &frame);
      if (!is_new)
        planning_.problems.add(frame.moved_by->place,
                               "{} moves {} and {}, so they and their parents need a \"coord\"",
                               frame.moved_by->value.text(), other->second->name, frame.name);
    }
  }

  [[nodiscard]] std::int64_t number_of(const std::string& name) const {
    if (auto standard = kStandard.find(name); standard != kStandard.end()) return standard->second;
    auto frame = by_name_.find(name);
    return frame == by_name_.end() ? 0 : frame->second->coord.value;
  }

  /// The names of frames as the modules of a file see them, by full name. Without prefix are the
  /// frames declared in that file, and a standard frame if it is the only one of its name in the
  /// files included there, or, if these have none, in all files.
  [[nodiscard]] std::map<std::string, std::string> names_for(int file,
                                                             const std::string& prefix) const {
    auto local = [](const GraphFrame& frame) { return frame.name.substr(frame.prefix.size()); };
    auto is_inside = [&](const GraphFrame& frame) { return frame.prefix.starts_with(prefix); };
    std::map<std::string, int> inside, all;  // frames by name without prefix
    for (const auto& frame : graph_.frames) {
      ++all[local(frame)];
      if (is_inside(frame)) ++inside[local(frame)];
    }
    std::map<std::string, std::string> names;
    for (const auto& frame : graph_.frames) {
      const std::string name = local(frame);
      const bool is_only =
          inside.contains(name) ? is_inside(frame) && inside.at(name) == 1 : all.at(name) == 1;
      const bool is_seen = frame.place.file == file || (kStandard.contains(name) && is_only);
      names[frame.name] = is_seen && !by_name_.contains(name) ? name : frame.name;
    }
    return names;
  }

  /// As in G31.
  [[nodiscard]] std::string text_for(int file, const std::string& prefix) const {
    const auto names = names_for(file, prefix);
    auto name_of = [&](const std::string& name) {
      auto seen = names.find(name);
      return seen == names.end() ? name : seen->second;
    };
    std::ostringstream text;
    for (const auto& frame : graph_.frames) {
      if (text.tellp() > 0) text << "; ";
      const std::string name = name_of(frame.name);
      text << name << " " << (kStandard.contains(name) ? kStandard.at(name) : number_of(frame.name))
           << " " << name_of(frame.parent.value);
      if (frame.moved_by) {
        const std::string mover = frame.moved_by->value.text();
        text << " " << mover << " " << planning_.plan.sources.at(mover);
        continue;
      }
      for (double length : frame.translation) text << hc::format(" {}", length);
      for (double part : frame.rotation) text << hc::format(" {}", part);
    }
    return text.str();
  }

  Planning& planning_;
  const Graph& graph_;
  std::map<std::string, const GraphFrame*> by_name_;
};

}  // namespace

bool takes_frames(const Planning& planning, const std::string& module) {
  const Description* description = planning.description_of(module);
  return description != nullptr && has_text_parameter(*description, kFrames);
}

void link_frames(Planning& planning) {
  std::vector<Lined<GraphPort>> movers;  // unique, in the order of the file
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
  for (const auto& module : planning.graph.modules) {
    if (!takes_frames(planning, module.name) || module.parameters.contains(kFrames)) continue;
    if (find_input(*planning.description_of(module.name), kFrames) == nullptr) continue;
    GraphLink link;
    link.to = {module.name, kFrames, {}};
    link.policy["keep"] = {kKeep, {}};
    if (planning.is_linked(link.to)) continue;
    for (const auto& mover : movers) {
      if (mover.value.module == module.name) continue;
      link.from = mover.value;
      link.place = mover.place;
      planning.graph.links.push_back(link);
    }
  }
}

void plan_frames(Planning& planning) {
  Frames(planning).run();
}

}  // namespace hc::internal
