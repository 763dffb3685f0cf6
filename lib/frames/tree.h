// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where things are: coordinate systems joined to a tree, and the way from one to another at the
// time of an image. No messages, no clock; frames/messages.h makes transformations of messages.
// Not safe for several threads at once; const calls alone are.

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

/// Numbers of frames are below this, so that a message can hold two of them (R44).
inline constexpr std::int32_t kFrameNumbers = 1000;

/// A frame of the specification.
struct StandardFrame {
  std::int32_t number;
  std::string_view name;
};

/// The metric frames that have a number everywhere. Source: the table in spec/mtp-1.md, R44.
inline constexpr StandardFrame kStandardFrames[] = {
    {1, "world"},     {2, "robot"},         {3, "head"},       {4, "left_eye"},
    {5, "right_eye"}, {6, "cyclopean_eye"}, {14, "supervisor"}};

/// A tree (or several) of frames, each joined to its parent by a transformation that is fixed, or
/// that moves and is fed with poses as they are measured.
///
///     Tree tree = Tree::standard();
///     tree.fix("world", "robot", T_world_robot);            // each gives a Status to look at
///     tree.join("robot", "head");
///     tree.fix("head", "left_eye", T_head_left_eye);
///     …
///     tree.feed("robot", "head", report.header.time, T_robot_head);
///     …
///     auto T_world_left_eye = tree.lookup("world", "left_eye", image.header.time);
///     if (!T_world_left_eye) return T_world_left_eye.error();
///     Eigen::Vector3d p_world = *T_world_left_eye * p_left_eye;
///
/// Every T_parent_child, (4, 4) f64, takes points in the child's frame to points in the parent's,
/// translations in metres; times are nanoseconds since the Unix epoch, as in a header.
/// Error details begin with "frames: " and are one line.
class Tree {
 public:
  /// A tree without frames.
  Tree() = default;
  /// kStandardFrames, not joined yet.
  static Tree standard();

  /// Makes a frame known.
  ///
  /// @param number  1 … 999.
  /// Errors: Invalid (a number out of range; a number or a name that is taken; a name that is
  /// empty or has a blank or control byte).
  Status add(std::int32_t number, std::string_view name);
  /// The same of a frame without a number.
  Status add(std::string_view name);

  /// Joins `child` to `parent` for good.
  ///
  /// Errors: NotFound (no such frame); Malformed (rigid() refuses it); Invalid (the child has a
  /// parent; a cycle).
  Status fix(const Frame& parent, const Frame& child, const Eigen::Isometry3d& T_parent_child);

  /// Joins `child` to `parent` by a transformation that moves; it is known from the first feed()
  /// on.
  ///
  /// Errors: NotFound (no such frame); Invalid (the child has a parent; a cycle; a memory for
  /// nothing, or that joins nothing).
  Status join(const Frame& parent, const Frame& child, const Memory& memory = {});

  /// Adds the pose of `child`, which join() joined, at a time. Poses may come in any order; one of
  /// a known time replaces the earlier one. One older than the joint's memory is dropped, which is
  /// no error but is reported (Fed::TooOld): after a clock was set back, call forget().
  ///
  /// @param time  [ns], over 0.
  /// Errors: NotFound (no such frame); Malformed (rigid() refuses it; a time of 0 or below);
  /// Invalid (these two are not joined so, or fixed). Nothing changes then. Cost: constant, for the
  /// latest time; see Track::add().
  Result<Fed> feed(const Frame& parent, const Frame& child, std::int64_t time,
                   const Eigen::Isometry3d& T_parent_child);

  /// T_target_source, which takes points in `source` to points in `target`, both at `time`. Between
  /// two poses of a joint it is interpolated as between() does, in the parent's frame; outside
  /// them, and between two that are further apart than its Memory::gap, nothing is known. What is
  /// above the frames' nearest common one is not asked.
  ///
  /// @param time  [ns]; of no importance where all that lies between is fixed.
  /// Errors: NotFound (no such frame; frames that are not joined; a joint on the way that is not
  /// known at that time: "frames: head in robot is known from 10 to 20 ns, asked for 25 ns: 5 ns
  /// too late").
  /// Cost: a product for each joint on the way; logarithmic in the poses of a moving one and in the
  /// number of frames. No allocation unless it fails.
  [[nodiscard]] Result<Eigen::Isometry3d> lookup(const Frame& target, const Frame& source,
                                                 std::int64_t time) const;

  /// The same for what does not move unless a pose says so, such as a head whose unit is silent: a
  /// joint without a pose at `time` keeps its last one before it (or takes the first after it);
  /// without any pose it is the identity.
  ///
  /// Errors: NotFound (no such frame; frames that are not joined). Cost: as lookup().
  [[nodiscard]] Result<Eigen::Isometry3d> nearest(const Frame& target, const Frame& source,
                                                  std::int64_t time) const;

  /// When lookup() of these two succeeds: the latest span without a gap in it, whose `last` is
  /// their latest common time. A default TimeSpan, hence always, where all that lies between is
  /// fixed.
  ///
  /// Cost: linear in the poses of that span.
  /// Errors: NotFound (no such frame; not joined; a joint that was not fed; no time in common).
  [[nodiscard]] Result<TimeSpan> known(const Frame& target, const Frame& source) const;

  /// Whether a pose of a time may still come: a joint between the two has none at or after it.
  /// False where there are no such frames, or all that lies between is fixed.
  [[nodiscard]] bool is_ahead(const Frame& target, const Frame& source, std::int64_t time) const;

  /// The names of all frames, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  /// The frames from `source` to `target`, both included.
  /// Errors: NotFound (no such frame; frames that are not joined).
  [[nodiscard]] Result<std::vector<std::string>> chain(const Frame& target,
                                                       const Frame& source) const;

  /// Forgets every pose: for a simulation or a recording that starts over.
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
  /// Two frames, and the nearest that is above both, or one of them.
  struct Way {
    std::size_t target, source, common;
  };
  [[nodiscard]] Result<Way> find_way(const Frame& target, const Frame& source) const;
  [[nodiscard]] std::size_t depth(std::size_t node) const;
  [[nodiscard]] std::size_t root(std::size_t node) const;
  [[nodiscard]] std::string joint_name(std::size_t child) const;
  /// The track of a joint that moves, fed once at least; null: it is fixed.
  [[nodiscard]] Result<const Track*> track_of(std::size_t child) const;
  /// T_parent_child at a time, or where it was last.
  [[nodiscard]] Result<Eigen::Isometry3d> joint_at(std::size_t child, std::int64_t time) const;
  [[nodiscard]] Eigen::Isometry3d joint_nearest(std::size_t child, std::int64_t time) const;
  /// T_target_source out of T_parent_child of every joint between, by one of the two.
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
