// SPDX-License-Identifier: Apache-2.0
#pragma once
// The simulator's parameters, and values derived from them.

#include <string>

#include <graphics/camera.h>
#include <hc/module/module.h>

#include <room/ball.h>
#include <room/head.h>
#include <room/people.h>

struct Parameters {
  hc::Module& module;

  hc::Parameter<std::int64_t> seed = module.parameter(
      "seed", 1, "", "of the world, the ball and the noise", {.min = 0, .max = 1e9, .fixed = true});
  hc::Parameter<double> rate = module.parameter("rate", 20.0, "Hz", "pairs of images a second",
                                                {.min = 0.1, .max = 1000, .fixed = true});
  hc::Parameter<std::int64_t> count =
      module.parameter("count", 0, "", "pairs to send, 0: all", {.min = 0});
  hc::Parameter<bool> paced = module.parameter(
      "paced", true, "", "in real time; false: as fast as images are drawn", {.fixed = true});
  hc::Parameter<double> neck_delay = module.parameter(
      "neck_delay", 0.0, "s",
      "if above 0, and not paced: delay from the time of a pose of `gaze` to the head's "
      "motion; an image waits for all poses up to its time",
      {.min = 0, .max = 10, .fixed = true});
  hc::Parameter<std::int64_t> start = module.parameter(
      "start", 0, "ns", "time of the first image, 0: now",
      {.min = 0, .max = 4e18, .fixed = true});  // 2096, so that no time after it overflows

  hc::Parameter<std::int64_t> width = module.parameter("width", 800, "px", "of the images",
                                                       {.min = 16, .max = 8192, .fixed = true});
  hc::Parameter<std::int64_t> height = module.parameter("height", 600, "px", "of the images",
                                                        {.min = 16, .max = 8192, .fixed = true});
  hc::Parameter<double> focal = module.parameter("focal", 600.0, "px", "focal length of the eyes",
                                                 {.min = 10, .max = 1e5, .fixed = true});
  hc::Parameter<double> noise = module.parameter(
      "noise", 2.0, "", "standard deviation of the noise, of 255", {.min = 0, .max = 40});
  hc::Parameter<double> blur =
      module.parameter("blur", 0.0, "px", "standard deviation of the blur", {.min = 0, .max = 20});
  hc::Parameter<double> exposure = module.parameter(
      "exposure", 1.0, "", "brightness of the images, 1: nominal", {.min = 0, .max = 10});
  hc::Parameter<double> latency = module.parameter(
      "latency", 0.0, "s", "from taking an image to sending it", {.min = 0, .max = 2});
  hc::Parameter<bool> swapped =
      module.parameter("swapped", false, "", "the eyes' cables are swapped");

  hc::Parameter<double> zero_pan =
      module.parameter("zero_pan", 0.0, "rad", "pan of the eyes with the unit at 0",
                       {.min = -0.5, .max = 0.5, .fixed = true});
  hc::Parameter<double> zero_tilt = module.parameter("zero_tilt", 0.0, "rad", "the same of tilt",
                                                     {.min = -0.5, .max = 0.5, .fixed = true});
  hc::Parameter<double> offset_roll =
      module.parameter("offset_roll", 0.0, "rad", "of the right eye, about its z",
                       {.min = -0.5, .max = 0.5, .fixed = true});
  hc::Parameter<double> offset_pitch =
      module.parameter("offset_pitch", 0.0, "rad", "of the right eye, about its x",
                       {.min = -0.5, .max = 0.5, .fixed = true});
  hc::Parameter<double> offset_yaw =
      module.parameter("offset_yaw", 0.0, "rad", "of the right eye, about its y",
                       {.min = -0.5, .max = 0.5, .fixed = true});

  hc::Parameter<std::string> ball =
      module.parameter("ball", "roll", "", "motion of the ball",
                       {.choices = {"still", "roll", "bounce", "hide", "absent"}, .fixed = true});
  hc::Parameter<double> ball_speed = module.parameter(
      "ball_speed", 0.349, "rad/s", "as seen from the robot", {.min = 0, .max = 10, .fixed = true});
  hc::Parameter<double> ball_hidden = module.parameter(
      "ball_hidden", 2.0, "s", "rest behind the screen", {.min = 0, .max = 60, .fixed = true});
  hc::Parameter<std::int64_t> people = module.parameter(
      "people", 0, "",
      "persons in the room; if any, it is cleared for them: no ball, bench, screen, stool and "
      "loudspeaker, and only the marker at the wall",
      {.min = 0, .max = hc::room::kMostPeople, .fixed = true});
  hc::Parameter<std::string> people_motion = module.parameter(
      "people_motion", "still", "",
      "what they do; one at a time: talk, point, and palm to victory, which are signs of a hand",
      {.choices = {"still", "walk", "cross", "wave", "talk", "point", "palm", "thumb", "fist",
                   "victory"},
       .fixed = true});
  hc::Parameter<std::string> text =
      module.parameter("text", "HELLO ROBOT", "", "text on the board");

  [[nodiscard]] std::uint64_t world_seed() const { return static_cast<std::uint64_t>(*seed); }
  [[nodiscard]] hc::room::BallMotion motion() const {
    return {*ball, *ball_speed, *ball_hidden, world_seed()};
  }
  [[nodiscard]] bool has_ball() const { return *ball != "absent" && *people == 0; }
  [[nodiscard]] hc::room::PeopleMotion motion_of_people() const {
    return {static_cast<int>(*people), *people_motion, world_seed()};
  }
  [[nodiscard]] hc::room::HeadFaults faults() const {
    return {*zero_pan, *zero_tilt, *offset_roll, *offset_pitch, *offset_yaw};
  }
  /// Of both eyes; the principal point is the centre of the image.
  [[nodiscard]] hc::graphics::PinholeCamera camera() const {
    hc::graphics::PinholeCamera camera;
    camera.width = static_cast<int>(*width);
    camera.height = static_cast<int>(*height);
    camera.fx = camera.fy = *focal;
    camera.cx = (camera.width - 1) / 2.0;
    camera.cy = (camera.height - 1) / 2.0;
    return camera;
  }
};
