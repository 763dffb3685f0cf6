// SPDX-License-Identifier: Apache-2.0
#pragma once
// The frames of a module's graph: where its eyes, its head and all else are, at the time of a
// message.
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
// `hc run` passes on what [frames] of the graph file says, and links what moves them
// (spec/graph.md, G31); without it, the default head is assumed (default_head.h).

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
    frames::Memory memory = {};  ///< of each joint that moves
    /// After so long without a pose none is awaited: the frame is at rest, or its sender has ended.
    std::chrono::nanoseconds silence = std::chrono::milliseconds(100);
    std::chrono::nanoseconds first{0};  ///< how long the first pose of all is awaited
    bool input = true;                  ///< take poses by an input; false: feed() alone
  };
  using Handler = std::function<void(const Result<Eigen::Isometry3d>&)>;

  /// Declares the parameter `frames`, and the input `frames`. Outlives run(), as the module does.
  explicit ModuleFrames(Module& module) : ModuleFrames(module, Options{}) {}
  ModuleFrames(Module& module, const Options& options);
  ModuleFrames(const ModuleFrames&) = delete;
  ModuleFrames& operator=(const ModuleFrames&) = delete;

  /// All frames. A parameter `frames` that cannot be read ends the module. Not before run().
  [[nodiscard]] const frames::Tree& tree() { return known().tree; }
  /// T_target_source at a time; see frames::Tree::lookup().
  [[nodiscard]] Result<Eigen::Isometry3d> lookup(const frames::Frame& target,
                                                 const frames::Frame& source, std::int64_t time) {
    return tree().lookup(target, source, time);
  }
  /// The same for joints that do not move unless a pose says so; unknown frames end the
  /// module. See frames::Tree::nearest().
  [[nodiscard]] Eigen::Isometry3d nearest(const frames::Frame& target, const frames::Frame& source,
                                          std::int64_t time);
  /// The same of joints that are fixed.
  [[nodiscard]] Eigen::Isometry3d fixed(const frames::Frame& target, const frames::Frame& source);

  /// Whether lookup() of a time to come is worth waiting for: as long as poses come.
  [[nodiscard]] bool awaits(const frames::Frame& target, const frames::Frame& source,
                            std::int64_t time);
  /// Calls a handler with what lookup() says of a time, as soon as that is no longer awaited: at
  /// once, or between messages. Handlers are called in the order of these calls; at most 256 wait,
  /// the oldest is called then. What it sends needs a time, since no message is being handled.
  void when_known(const frames::Frame& target, const frames::Frame& source, std::int64_t time,
                  Handler handler);
  /// Calls the handlers that need not wait any more: done between messages and by feed().
  void answer_known();
  /// Calls all handlers that wait: at the end, when no pose comes any more.
  void answer_all();

  /// Takes in a pose that the module itself knows, as Tree::feed(). A pose more than 1 s before the
  /// last of its joint is of a clock that was set back: all that was known is forgotten.
  Status feed(std::string_view parent, std::string_view child, std::int64_t time,
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
    std::int64_t time, since;
    Handler handler;
  };
  frames::GraphFrames& known();
  [[nodiscard]] bool is_awaited(const Waiting& waiting);

  Module& module_;
  Options options_;
  Parameter<std::string> text_;
  std::optional<frames::GraphFrames> frames_;
  std::map<std::string, std::int64_t, std::less<>> newest_;  // pose of each child [ns]
  std::int64_t fed_ = 0;                                     // when a pose came last [ns]
  std::deque<Waiting> waiting_;
};

}  // namespace hc
