// SPDX-License-Identifier: Apache-2.0
#pragma once
// Turns the head to a target, setpoint or stick, and bids for the head while there is one.

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include <frames/module_frames.h>
#include <hc/base/turn.h>
#include <hc/module/module.h>
#include <vision/marker.h>

#include "controller.h"
#include "parameters.h"

class Gaze {
 public:
  /// @param module  must outlive it.
  explicit Gaze(hc::Module& module);

 private:
  using Sources = hc::Turn<std::int32_t>;
  /// A pushed stick is repeated; after this silence it counts as released.
  static constexpr std::chrono::milliseconds kLetGo{250};

  void start();
  void calibrate(const hc::MessageOf<hc::TableKind<double>>& message);
  void see(const hc::Message& message);
  void set(const hc::MessageOf<hc::RotationKind<double>>& message);
  void push(const hc::MessageOf<hc::TableKind<double>>& message);

  /// Says what is assumed of the eyes in whose images a target is.
  void check_camera();
  void follow() { send(controller_->follow(module_.now(), measured())); }
  void steer() { send(controller_->steer(module_.now(), measured())); }
  void send(const std::optional<hc::gaze::Angles>& to);
  void send_bid();

  [[nodiscard]] hc::gaze::Angles measured();
  /// Time of a message. Drops old ones, and ones from the future, which would block all until then.
  hc::Time time_of(const hc::Header& header, double oldest) const;
  /// Drops a message whose frame has no transform to the robot's.
  void check_frame(std::int32_t frame, const std::string& others);
  /// Whether a source is in control, of several that send to one input.
  [[nodiscard]] bool has_turn(const std::string& what, Sources& turn, std::int32_t source);

  hc::Module& module_;
  hc::Input<hc::AnyKind> target_ = module_.input(
      "target",
      hc::any_of(hc::position(), hc::transformation(),
                 hc::table().of(0, hc::vision::kMarkerColumns)),
      "x, y in the left (7) or right (8) image [px], or a position in any frame [m]; a "
      "pose of marker, or its table; in each image or frame of one source at a time",
      {.keep = 1});
  hc::Input<hc::RotationKind<double>> setpoint_ = module_.input(
      "setpoint", hc::rotation(),
      "orientation to take, roll, tilt, pan [rad]: of the neck (13) or a person's head "
      "(14), or in a frame; of one source at a time",
      {.keep = 1});
  hc::Input<hc::TableKind<double>> stick_ =
      module_.input("stick", hc::table().of(1, 2).finite(),
                    "turn to the left, turn down, -1 … 1 of stick_rate; repeated while "
                    "pushed; of one source at a time",
                    {.keep = 1});
  hc::Input<hc::TableKind<double>> calibration_ =
      module_.input("calibration", hc::table(), "result of calibrate", {.keep = 1});
  hc::Output<hc::RotationKind<double>> command_ =
      module_.output("command", hc::rotation().in(hc::Coord::kGaze),
                     "commanded head orientation: roll 0, tilt, pan [rad]");
  hc::Output<hc::TableKind<double>> bid_ = module_.output(
      "bid", hc::table(), "while there is a target, else idle_salience", {.columns = {"salience"}});
  hc::ModuleFrames frames_{module_};
  const GazeParameters parameters_{module_};

  hc::vision::AssumedCameras assumed_{module_, "directions of targets in images may be wrong",
                                      "set calibration_file, or focal, cx and cy"};
  std::optional<Controller> controller_;  // from the start
  bool was_wanted_ = false;               // in the last bid
  Sources pushes_{kLetGo};
  std::optional<Sources> sets_;             // a setpoint
  std::map<std::int32_t, Sources> sights_;  // the target, by coordinate system
};
