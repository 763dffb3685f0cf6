// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the pose of the supervisor's head from any tracker that opentrack supports.

#include <optional>
#include <string>

#include <drivers/head_tracker/tracked_head.h>

#include <hc/module/module.h>

struct HeadTrackerParameters {
  hc::Module& module;

  hc::Parameter<std::string> listen =
      module.parameter("listen", "", "",
                       "[ADDRESS:]PORT of this machine to listen on by UDP, opentrack's "
                       "is 4242, 0: a free one; empty: none",
                       {.positional = true, .fixed = true});
  hc::Parameter<std::string> sender = module.parameter(
      "sender", "", "", "addresses of other machines that may send, separated by spaces",
      {.fixed = true});
  hc::Parameter<bool> centre_first = module.parameter(
      "centre_first", true, "", "the first pose is the zero; else the tracker's", {.fixed = true});
  hc::Parameter<double> silence = module.parameter(
      "silence", 1.0, "s", "time without packets until it is logged, and another sender accepted",
      {.min = 0.01, .max = 3600, .fixed = true});

  /// Those of the tracker. An invalid address ends the module.
  [[nodiscard]] hc::TrackedHeadOptions options() const;
};

class HeadTracker {
 public:
  /// @param module  must outlive it.
  explicit HeadTracker(hc::Module& module);

 private:
  void start();
  void pass();
  void receive();
  void send_address() { address_.send(head_->address(), module_.now()); }

  hc::Module& module_;
  hc::Input<hc::AnyKind> centre_ =
      module_.input("centre", hc::anything(), "makes the head's pose the new zero");
  hc::Output<hc::RotationKind<double>> rotation_ =
      module_.output("rotation", hc::rotation().in(hc::Coord::kSupervisor),
                     "roll, pitch, yaw since the zero [rad]; yaw > 0 turns left, pitch "
                     "> 0 looks down");
  hc::Output<hc::PositionKind<double>> position_ =
      module_.output("position", hc::position().in(hc::Coord::kSupervisor),
                     "x forward, y left, z up since the zero [m]");
  hc::Output<hc::StringKind> address_ = module_.output(
      "address", hc::string(), "listening address, 127.0.0.1:4242; each second and on change");
  const HeadTrackerParameters parameters_{module_};

  const hc::SystemClock clock_;
  std::optional<hc::TrackedHead> head_;  // from the start
};
