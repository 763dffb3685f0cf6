// SPDX-License-Identifier: Apache-2.0
#pragma once
// A tree of coordinate systems, and transformations between them over time. No messages, no clock;
// frames/messages.h converts messages. Only const calls are thread-safe.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <frames/rigid.h>
#include <frames/track.h>

namespace hc::frames {

/// A coordinate system, by its number (`coord` in a header: spec/mtp-1.md, R44) or by its name.
using Frame = std::variant<std::int32_t, std::string_view>;

/// Numbers of frames are below this, so that a coord can contain two of them (R44).
inline constexpr std::int32_t kFrameNumbers = 1000;

/// A frame of the specification.
struct StandardFrame {
  std::int32_t number;
  std::string_view name;
};

/// The standard metric frames. Source: the table in spec/mtp-1.md, R44.
inline constexpr StandardFrame kStandardFrames[] = {
    {1, "world"},     {2, "robot"},         {3, "head"},       {4, "left_eye"},
    {5, "right_eye"}, {6, "cyclopean_eye"}, {14, "supervisor"}};

/// One or several trees of frames, each joined to its parent by a fixed transformation, or by a
/// moving one that is fed with measured poses.
///
///     Tree tree = Tree::standard();
///     tree.fix("world", "robot", T_world_robot);            // returns a Status to check
///     tree.join("robot", "head");
///     tree.fix("head", "left_eye", T_head_left_eye);
///     …
///     tree.feed("robot", "head", report.header.time, T_robot_head);
///     …
///     auto T_world_left_eye = tree.lookup("world", "left_eye", image.header.time);
///     if (!T_world_left_eye) return T_world_left_eye.error();
///     Eigen::Vector3d p_world = *T_world_left_eye * p_left_eye;
///
/// T_parent_child, (4, 4) f64, transforms points from the child's frame to the parent's,
/// translations in metres; times are those of headers. Error
/// details start with "frames: " and are one line.
class Tree {
 public:
  Tree() = default;
  /// kStandardFrames, not joined yet.
  static Tree standard();

  /// Adds a frame.
  ///
  /// @param number  1 … 999.
  /// Errors: Invalid (a number out of range; a number or name already taken; a name that is empty
  /// or has a blank or control byte).
  Status add(std::int32_t number, std::string_view name);
  /// Adds a frame without a number.
  Status add(std::string_view name);

  /// Joins `child` to `parent` by a fixed transformation.
  ///
  /// Errors: NotFound (no such frame); Malformed (rigid() refuses it); Invalid (the child has a
  /// parent; a cycle).
  Status fix(const Frame& parent, const Frame& child, const Eigen::Isometry3d& T_parent_child);

  /// Joins `child` to `parent` by a moving transformation, known from the first feed() on.
  ///
  /// Errors: NotFound (no such frame); Invalid (the child has a parent; a cycle; a gap of 0, …).
  Status join(const Frame& parent, const Frame& child, const Memory& memory = {});

  /// Adds a pose of `child`, which was joined with join(). Poses may arrive in any order; one with
  /// a known time replaces the earlier one. One older than the joint's memory is dropped, and
  /// reported as Fed::TooOld, which is not an error: after a clock was set back, call forget().
  ///
  /// @param time  after the Unix epoch.
  /// Errors: NotFound (no such frame); Malformed (as rigid(); an unknown time); Invalid (not
  /// joined, or fixed). Then nothing changes. Cost: constant for the latest time; see Track::add().
  Result<Fed> feed(const Frame& parent, const Frame& child, Time time,
                   const Eigen::Isometry3d& T_parent_child);

  /// T_target_source, which transforms points from `source` to `target`, both at `time`. Poses of a
  /// joint are interpolated with between(), in the parent's frame, but not extrapolated, nor over
  /// more than Memory::gap. Joints above the nearest common ancestor are not used.
  ///
  /// @param time  irrelevant if all joints between are fixed.
  /// Errors: NotFound (no such frame; frames not joined; a joint unknown at that time: "frames:
  /// head in robot is known from 10 to 20 ns, asked for 25 ns: 5 ns too late"). Cost: a product per
  /// joint between; logarithmic in the poses of a moving one and in the number of frames. No
  /// allocation unless it fails.
  [[nodiscard]] Result<Eigen::Isometry3d> lookup(const Frame& target, const Frame& source,
                                                 Time time) const;

  /// The same, but a joint without a pose at `time` keeps the last one before it, or the first
  /// after it; the identity without any. For joints that rest while no poses arrive, such as a head
  /// whose unit is silent.
  ///
  /// Errors: NotFound (no such frame; frames not joined). Cost: as lookup().
  [[nodiscard]] Result<Eigen::Isometry3d> nearest(const Frame& target, const Frame& source,
                                                  Time time) const;

  /// When lookup() of these two succeeds: the latest span without a gap, whose `last` is their
  /// latest common time. A default TimeSpan (always) if all joints between are fixed.
  ///
  /// Cost: linear in the poses of that span.
  /// Errors: NotFound (no such frame; not joined; a joint without poses; no common time).
  [[nodiscard]] Result<TimeSpan> known(const Frame& target, const Frame& source) const;

  /// Whether a pose for a time may still arrive: a joint between the two has none at or after it.
  /// False for unknown frames, or if all joints between are fixed.
  [[nodiscard]] bool is_ahead(const Frame& target, const Frame& source, Time time) const;

  /// The names of all frames, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  /// The frames from `source` to `target`, inclusive.
  /// Errors: NotFound (no such frame; frames not joined).
  [[nodiscard]] Result<std::vector<std::string>> chain(const Frame& target,
                                                       const Frame& source) const;

  /// Forgets all poses, for a simulation or recording that restarts.
  void forget();

 private:
  struct Node {
    std::string name;
    std::size_t parent = kNone;
    std::variant<Eigen::Isometry3d, Track> joint = Eigen::Isometry3d::Identity();
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  Status add_node(const std::string& which, std::string_view name);
  [[nodiscard]] Result<std::size_t> find(const Frame& frame) const;
  /// Two frames and their nearest common ancestor.
  struct Way {
    std::size_t target, source, common;
  };
  [[nodiscard]] Result<Way> find_way(const Frame& target, const Frame& source) const;
  [[nodiscard]] std::size_t depth(std::size_t node) const;
  [[nodiscard]] std::size_t root(std::size_t node) const;
  [[nodiscard]] std::string joint_name(std::size_t child) const;
  /// The track of a moving joint; null if fixed. Errors: NotFound (no poses yet).
  [[nodiscard]] Result<const Track*> track_of(std::size_t child) const;
  /// T_parent_child at a time.
  [[nodiscard]] Result<Eigen::Isometry3d> joint_at(std::size_t child, Time time) const;
  [[nodiscard]] Eigen::Isometry3d joint_nearest(std::size_t child, Time time) const;
  /// T_target_source from T_parent_child of each joint between, given by `joint_of`.
  template <typename JointOf>
  Result<Eigen::Isometry3d> product(const Frame& target, const Frame& source,
                                    const JointOf& joint_of) const;
  Status attach(const Frame& parent, const Frame& child,
                std::variant<Eigen::Isometry3d, Track> joint);

  std::vector<Node> nodes_;
  std::map<std::int32_t, std::size_t> by_number_;
  std::map<std::string, std::size_t, std::less<>> by_name_;
};

}  // namespace hc::frames
