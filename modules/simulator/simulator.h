// SPDX-License-Identifier: Apache-2.0
#pragma once
// Simulates a robot head in a room: images, sound, and the ground truth.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <frames/module_frames.h>
#include <hc/module/module.h>

#include <room/ball.h>
#include <room/people.h>
#include <room/world.h>
#include "ears.h"
#include "eyes.h"
#include "neck.h"
#include "parameters.h"
#include "people_truth.h"
#include "schedule.h"
#include "truth.h"

class Simulator {
 public:
  /// @param module  must outlive it.
  explicit Simulator(hc::Module& module);

 private:
  /// Made when the parameters are known.
  struct Scene {
    std::unique_ptr<hc::graphics::Renderer> renderer;
    hc::room::World world;
    hc::room::Ball ball;
    hc::room::People people;
    hc::room::Head head;
    hc::graphics::PinholeCamera camera;
    Schedule schedule;
    Eyes eyes;
    Ears ears;
  };
  static constexpr std::chrono::seconds kSilence{60};  // longest wait of an image for a pose
  static constexpr std::chrono::nanoseconds kNow{0};

  void start();
  std::unique_ptr<Scene> make_scene();
  void write(const std::string& what);
  void write_parameter();

  void take_gaze(const hc::Message& message);
  void turn(hc::Time time, const Eigen::Quaterniond& R_robot_head);
  /// Takes images when they are due, or as fast as possible.
  void generate();
  /// In the time of messages: takes an image when all poses until then are known.
  void step();
  void fail_by_silence() const;

  void take();
  void look(const std::vector<hc::graphics::Item>& items, const Eigen::Isometry3d& T_world_head);
  /// What is heard: the voices of the persons, or the loudspeaker where nobody is.
  [[nodiscard]] std::vector<hc::room::Source> sources(const std::vector<hc::room::Person>& people);
  [[nodiscard]] bool is_done() const;

  hc::Module& module_;
  hc::Input<hc::RotationKind<double>> gaze_ =
      module_.input("gaze", hc::rotation().in(hc::Coord::kGaze),
                    "roll, tilt, pan of the pan-tilt unit [rad]; straight ahead without");
  hc::Input<hc::StringKind> text_ =
      module_.input("text", hc::string(), "text to write on the board");
  hc::Output<hc::RgbImageKind<std::uint8_t>> left_ =
      module_.output("left", hc::rgb_image().in(hc::Coord::kLeftImage), "left eye");
  hc::Output<hc::RgbImageKind<std::uint8_t>> right_ =
      module_.output("right", hc::rgb_image().in(hc::Coord::kRightImage), "right eye");
  hc::Output<hc::SoundKind<std::int16_t>> sound_ = module_.output(
      "sound", hc::sound(2).in(hc::Coord::kSound16k), "sound at the left and right ear");
  Truth truth_{module_};
  hc::Output<hc::TransformationKind<double>> neck_pose_ = module_.output(
      "neck_pose",
      hc::transformation().in(hc::transform_coord(hc::Coord::kRobot, hc::Coord::kHead)),
      "T_robot_head as the images were taken: what a neck reports");
  PeopleTruth people_truth_{module_};
  const Parameters parameters_{module_};
  // The head's pose comes from the input `gaze`.
  hc::ModuleFrames frames_{module_, {.input = false}};

  std::unique_ptr<Scene> scene_;
  std::optional<Neck> neck_;  // in the time of messages
  std::string last_parameter_;
  hc::Timeout silence_ = module_.after(kSilence, [this] { fail_by_silence(); });
  hc::Timeout step_ = module_.after(kNow, [this] { step(); });
};
