// SPDX-License-Identifier: Apache-2.0
#pragma once
// The tree of frames of a module's graph, at the time of a message.
//
//     hc::Module module{"mean_depth", "…"};
//     hc::ModuleFrames frames{module};
//     module.on(target, [&](const auto& message) {
//       const auto p = point_of(message);
//       frames.when_known("robot", "left_eye", message.header.time, [&, p](const auto& T) {
//         if (T) look_at(*T * p);
//       });
//     });
//
// `hc run` passes [frames] of the graph file, and links the poses of moving frames (spec/graph.md,
// G31); without it, the default head is assumed (default_head.h).

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include <frames/graph_frames.h>
#include <hc/module/module.h>

namespace hc {

class ModuleFrames {
 public:
  struct Options {
    frames::Memory memory = {};  ///< of each moving joint
    /// How long to wait for a pose since the last one, after which the frame counts as at rest.
    /// Time in which this module could not take poses does not count.
    std::chrono::nanoseconds silence = std::chrono::milliseconds(100);
    std::chrono::nanoseconds first{0};  ///< how long to wait for the very first pose
    bool input = true;                  ///< take poses from an input; false: only feed()
  };
  using Handler = std::function<void(const Result<Eigen::Isometry3d>&)>;

  /// Declares the parameter and the input `frames`. Must outlive run().
  explicit ModuleFrames(Module& module) : ModuleFrames(module, Options{}) {}
  ModuleFrames(Module& module, const Options& options);
  ModuleFrames(const ModuleFrames&) = delete;
  ModuleFrames& operator=(const ModuleFrames&) = delete;

  /// All frames. An invalid parameter `frames` ends the module. Not before run().
  [[nodiscard]] const frames::Tree& tree() { return known().tree; }
  /// Whether the graph has given them; else they are the default head's.
  [[nodiscard]] bool are_given() const { return text_.is_set(); }
  /// T_target_source at a time; see frames::Tree::lookup(). Here and below a time that is not
  /// given, Time{}, is now.
  [[nodiscard]] Result<Eigen::Isometry3d> lookup(const frames::Frame& target,
                                                 const frames::Frame& source, Time time) {
    return tree().lookup(target, source, given(time));
  }
  /// The same with the nearest known poses: Tree::nearest(). Unknown frames end the module.
  [[nodiscard]] Eigen::Isometry3d nearest(const frames::Frame& target, const frames::Frame& source,
                                          Time time);
  /// The same for fixed joints; a moving one ends the module.
  [[nodiscard]] Eigen::Isometry3d fixed(const frames::Frame& target, const frames::Frame& source);

  /// Whether to wait for lookup() at a time after the last pose: while poses arrive, and unless it
  /// is more than 1 s ahead of both now and the last pose, as a sender's clock may be wrong.
  [[nodiscard]] bool awaits(const frames::Frame& target, const frames::Frame& source, Time time);
  /// Calls a handler with the result of lookup(), as soon as there is no need to wait: at once, or
  /// between messages. Handlers are called in order; if more than 256 wait, the oldest is called.
  /// Messages sent by a handler need a time, since no message is being handled.
  void when_known(const frames::Frame& target, const frames::Frame& source, Time time,
                  Handler handler);
  /// Calls the handlers that need not wait any more; called between messages and by feed().
  void answer_known();
  /// Calls all waiting handlers; for the end, when no more poses arrive.
  void answer_all();

  /// Takes a pose from the module itself, as Tree::feed(). A pose more than 1 s before the last of
  /// its joint means that the clock was set back: all poses are forgotten.
  Status feed(std::string_view parent, std::string_view child, Time time,
              const Eigen::Isometry3d& T_parent_child);

 private:
  /// A Frame that owns its name.
  struct Name {
    explicit Name(const frames::Frame& frame);
    operator frames::Frame() const;

    std::int32_t number = 0;
    std::string name;
  };
  struct Waiting {
    Name target, source;
    Time time, since;
    Handler handler;
  };
  frames::GraphFrames& known();
  [[nodiscard]] Time given(Time time) const { return time > Time() ? time : module_.now(); }
  [[nodiscard]] bool is_awaited(const Waiting& waiting);
  /// Time without a pose.
  [[nodiscard]] std::chrono::nanoseconds silence() const;

  Module& module_;
  Options options_;
  Parameter<std::string> text_;
  std::optional<frames::GraphFrames> frames_;
  std::map<std::string, Time, std::less<>> newest_;  // pose of each child
  Time last_, fed_;                                  // of the last pose, and its arrival
  std::chrono::nanoseconds silence_{0};              // since then, with an input
  std::deque<Waiting> waiting_;
};

}  // namespace hc
