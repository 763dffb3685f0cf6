// SPDX-License-Identifier: Apache-2.0
#include <frames/tree.h>

#include <algorithm>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/json_string.h>
#include <hc/base/suggestion.h>

namespace hc::frames {
namespace {

Error error(Code code, const std::string& what) {
  return Error{code, "frames: " + what};
}

constexpr auto ns = unix_nanoseconds;

/// A duration as text: "12.3 ms".
std::string duration(std::uint64_t nanoseconds) {
  if (nanoseconds < 1000) return std::to_string(nanoseconds) + " ns";
  double value = static_cast<double>(nanoseconds) / 1e3;
  const char* unit = " µs";
  for (const char* next : {" ms", " s"}) {
    if (value < 999.95) break;  // more would be shown as 1000.0
    value /= 1e3;
    unit = next;
  }
  return hc::format("{:.1f}{}", value, unit);
}

/// ", asked for 25 ns: 5 ns too late", of a time outside the span.
std::string outside(Time time, TimeSpan span) {
  if (time == Time()) return ", asked for time 0, which means unknown";
  // Unsigned, so that no difference overflows.
  auto since = [](Time later, Time earlier) {
    return duration(static_cast<std::uint64_t>(ns(later)) -
                    static_cast<std::uint64_t>(ns(earlier)));
  };
  return ", asked for " + std::to_string(ns(time)) + " ns: " +
         (time < span.first ? since(span.first, time) + " too early"
                            : since(time, span.last) + " too late");
}

}  // namespace

Tree Tree::standard() {
  Tree tree;
  for (auto [number, name] : kStandardFrames) {
    auto added = tree.add(number, name);
    HC_CHECK(added.has_value());
  }
  return tree;
}

Status Tree::add(std::int32_t number, std::string_view name) {
  std::string which = "frame " + std::to_string(number);
  if (number < 1 || number >= kFrameNumbers)
    return error(Code::Invalid, which + " is not within 1 … " + std::to_string(kFrameNumbers - 1));
  if (auto taken = by_number_.find(number); taken != by_number_.end())
    return error(Code::Invalid, which + " is " + nodes_[taken->second].name + " already");
  auto added = add_node(which, name);
  if (added) by_number_.emplace(number, nodes_.size() - 1);
  return added;
}

Status Tree::add(std::string_view name) {
  return add_node("a frame", name);
}

Status Tree::add_node(const std::string& which, std::string_view name) {
  if (name.empty()) return error(Code::Invalid, which + " has no name");
  if (std::any_of(name.begin(), name.end(), [](char c) { return c >= 0 && c <= ' '; }))
    return error(Code::Invalid, which + " has a name with a blank");
  if (by_name_.contains(name))
    return error(Code::Invalid, "there is a frame " + std::string(name) + " already");
  by_name_.emplace(name, nodes_.size());
  nodes_.emplace_back().name = name;
  return {};
}

Result<std::size_t> Tree::find(const Frame& frame) const {
  if (const auto* number = std::get_if<std::int32_t>(&frame)) {
    auto found = by_number_.find(*number);
    if (found != by_number_.end()) return found->second;
    return error(Code::NotFound, "no frame " + std::to_string(*number));
  }
  std::string_view name = std::get<std::string_view>(frame);
  auto found = by_name_.find(name);
  if (found != by_name_.end()) return found->second;
  std::string what = "no frame ";
  append_json_string(name, what);
  const auto known = names();
  const std::string meant = suggestion(name, known);
  if (meant.empty())
    for (std::size_t i = 0; i < known.size(); ++i) what += (i == 0 ? "; known: " : ", ") + known[i];
  return error(Code::NotFound, what + meant);
}

std::size_t Tree::depth(std::size_t node) const {
  std::size_t steps = 0;
  while ((node = nodes_[node].parent) != kNone) ++steps;
  return steps;
}

std::size_t Tree::root(std::size_t node) const {
  while (nodes_[node].parent != kNone) node = nodes_[node].parent;
  return node;
}

std::string Tree::joint_name(std::size_t child) const {
  return nodes_[child].name + " in " + nodes_[nodes_[child].parent].name;
}

Status Tree::attach(const Frame& parent, const Frame& child,
                    std::variant<Eigen::Isometry3d, Track> joint) {
  const auto p = HC_TRY(find(parent)), c = HC_TRY(find(child));
  Node& node = nodes_[c];
  const std::string wanted = node.name + " in " + nodes_[p].name;
  if (node.parent == p) return error(Code::Invalid, wanted + " is given twice");
  if (node.parent != kNone)
    return error(Code::Invalid, wanted + " would be a second parent: there is " + joint_name(c));
  if (root(p) == c) return error(Code::Invalid, wanted + " would close a cycle");
  node.parent = p;
  node.joint = std::move(joint);
  return {};
}

Status Tree::fix(const Frame& parent, const Frame& child, const Eigen::Isometry3d& T_parent_child) {
  auto checked = HC_TRY(rigid(T_parent_child.matrix()));
  return attach(parent, child, checked);
}

Status Tree::join(const Frame& parent, const Frame& child, const Memory& memory) {
  if (memory.span.count() <= 0 || memory.poses == 0)
    return error(Code::Invalid, hc::format("a memory of {} poses over {} ns stores nothing",
                                           memory.poses, memory.span.count()));
  if (memory.gap.count() <= 0)
    return error(Code::Invalid,
                 "a gap of " + std::to_string(memory.gap.count()) + " ns joins nothing");
  return attach(parent, child, Track(memory));
}

Result<Fed> Tree::feed(const Frame& parent, const Frame& child, Time time,
                       const Eigen::Isometry3d& T_parent_child) {
  const auto p = HC_TRY(find(parent)), c = HC_TRY(find(child));
  Node& node = nodes_[c];
  if (node.parent != p)
    return error(Code::Invalid, node.name + " in " + nodes_[p].name + " is fed, but not joined");
  auto* track = std::get_if<Track>(&node.joint);
  if (track == nullptr) return error(Code::Invalid, joint_name(c) + " is fed, but fixed");
  if (time <= Time()) return error(Code::Malformed, joint_name(c) + " is fed without a time");
  auto checked = HC_TRY(rigid(T_parent_child.matrix()));
  return track->add(time, Pose(checked));
}

Result<Tree::Way> Tree::find_way(const Frame& target, const Frame& source) const {
  const auto t = HC_TRY(find(target)), s = HC_TRY(find(source));
  auto a = t, b = s;
  std::size_t depth_a = depth(a), depth_b = depth(b);
  for (; depth_a > depth_b; --depth_a) a = nodes_[a].parent;
  for (; depth_b > depth_a; --depth_b) b = nodes_[b].parent;
  while (a != b && a != kNone) {
    a = nodes_[a].parent;
    b = nodes_[b].parent;
  }
  if (a != kNone) return Way{t, s, a};
  return error(Code::NotFound, nodes_[t].name + " and " + nodes_[s].name +
                                   " are not joined: above them are " + nodes_[root(t)].name +
                                   " and " + nodes_[root(s)].name);
}

Result<const Track*> Tree::track_of(std::size_t child) const {
  const auto* track = std::get_if<Track>(&nodes_[child].joint);
  if (track != nullptr && track->empty())
    return error(Code::NotFound, joint_name(child) + " has no pose yet");
  return track;
}

Result<Eigen::Isometry3d> Tree::joint_at(std::size_t child, Time time) const {
  auto track = HC_TRY(track_of(child));
  if (track == nullptr) return std::get<Eigen::Isometry3d>(nodes_[child].joint);
  const TimeSpan span = track->known();
  if (time < span.first || time > span.last)
    return error(Code::NotFound, hc::format("{} is known from {} to {} ns{}", joint_name(child),
                                            ns(span.first), ns(span.last), outside(time, span)));
  if (auto gap = track->gap_at(time))
    return error(
        Code::NotFound,
        hc::format("{} is not known between {} and {} ns, asked for {} ns: a gap of {}",
                   joint_name(child), ns(gap->first), ns(gap->last), ns(time),
                   duration(static_cast<std::uint64_t>((gap->last - gap->first).count()))));
  return track->at(time).transformation();
}

Eigen::Isometry3d Tree::joint_nearest(std::size_t child, Time time) const {
  if (const auto* fixed = std::get_if<Eigen::Isometry3d>(&nodes_[child].joint)) return *fixed;
  const auto& track = std::get<Track>(nodes_[child].joint);
  return track.empty() ? Eigen::Isometry3d::Identity() : track.nearest(time).transformation();
}

template <typename JointOf>
Result<Eigen::Isometry3d> Tree::product(const Frame& target, const Frame& source,
                                        const JointOf& joint_of) const {
  const auto [t, s, common] = HC_TRY(find_way(target, source));
  Eigen::Isometry3d T_common[2];  // of the target and the source
  for (int i = 0; i < 2; ++i) {
    T_common[i].setIdentity();
    for (std::size_t at = i == 0 ? t : s; at != common; at = nodes_[at].parent) {
      Result<Eigen::Isometry3d> joint = joint_of(at);
      if (!joint) return joint.error();
      T_common[i] = *joint * T_common[i];
    }
  }
  Eigen::Isometry3d T_target_source = T_common[0].inverse() * T_common[1];
  return T_target_source;
}

Result<Eigen::Isometry3d> Tree::lookup(const Frame& target, const Frame& source, Time time) const {
  return product(target, source, [&](std::size_t child) { return joint_at(child, time); });
}

Result<Eigen::Isometry3d> Tree::nearest(const Frame& target, const Frame& source, Time time) const {
  return product(target, source, [&](std::size_t child) { return joint_nearest(child, time); });
}

bool Tree::is_ahead(const Frame& target, const Frame& source, Time time) const {
  bool is_ahead = false;
  auto look = [&](std::size_t child) -> Result<Eigen::Isometry3d> {
    const auto* track = std::get_if<Track>(&nodes_[child].joint);
    is_ahead |= track != nullptr && (track->empty() || track->known().last < time);
    return Eigen::Isometry3d::Identity();
  };
  return product(target, source, look).has_value() && is_ahead;
}

std::vector<std::string> Tree::names() const {
  std::vector<std::string> names;
  for (const auto& [name, node] : by_name_) names.push_back(name);
  return names;
}

Result<std::vector<std::string>> Tree::chain(const Frame& target, const Frame& source) const {
  const auto [t, s, common] = HC_TRY(find_way(target, source));
  std::vector<std::string> names, down;
  for (std::size_t at = s; at != common; at = nodes_[at].parent) names.push_back(nodes_[at].name);
  for (std::size_t at = t; at != common; at = nodes_[at].parent) down.push_back(nodes_[at].name);
  names.push_back(nodes_[common].name);
  names.insert(names.end(), down.rbegin(), down.rend());
  return names;
}

Result<TimeSpan> Tree::known(const Frame& target, const Frame& source) const {
  const auto [t, s, common] = HC_TRY(find_way(target, source));
  std::vector<const Track*> moving;
  TimeSpan all;                                  // common span, ignoring gaps
  std::size_t latest = kNone, earliest = kNone;  // the joints that bound `all`
  for (std::size_t end : {s, t}) {
    for (std::size_t at = end; at != common; at = nodes_[at].parent) {
      auto track = HC_TRY(track_of(at));
      if (track == nullptr) continue;
      moving.push_back(track);
      const TimeSpan span = track->known();
      if (span.first > all.first) {
        all.first = span.first;
        latest = at;
      }
      if (span.last < all.last) {
        all.last = span.last;
        earliest = at;
      }
    }
  }
  if (all.first > all.last)
    return error(Code::NotFound,
                 hc::format("{} is known to {} ns and {} from {} ns: no common time",
                            joint_name(earliest), ns(all.last), joint_name(latest), ns(all.first)));
  // Goes back from the end, to before each gap, until there is none.
  TimeSpan both = all;
  for (bool is_settled = false; !is_settled;) {
    is_settled = true;
    both.first = all.first;
    for (const Track* track : moving) {
      auto span = track->known_until(both.last);
      if (!span || span->last < all.first)
        return error(Code::NotFound, hc::format("between {} and {} ns some joint always has a gap",
                                                ns(all.first), ns(all.last)));
      is_settled = is_settled && span->last == both.last;
      both.last = span->last;
      both.first = std::max(both.first, span->first);
    }
  }
  return both;
}

void Tree::forget() {
  for (Node& node : nodes_)
    if (auto* track = std::get_if<Track>(&node.joint)) track->clear();
}

}  // namespace hc::frames
