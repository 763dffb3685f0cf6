// SPDX-License-Identifier: Apache-2.0
#pragma once
// A task: turns the head a little to all sides to calibrate the mounting of its eyes.

#include <cstdint>
#include <future>
#include <optional>
#include <stop_token>
#include <string>

#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <vision/module_cameras.h>

#include "calibrate.h"
#include "tour.h"

struct CalibratorParameters {
  hc::Module& module;

  hc::Parameter<std::string> calibration_file = module.parameter(
      "calibration_file", "", "",
      "file of stereo_calibration: the result is added to it, and read from it if it has one",
      {.positional = true, .fixed = true});
  hc::Parameter<double> turn =
      module.parameter("turn", 0.28, "rad", "how far the head turns to each side",
                       {.min = 0.05, .max = 0.6, .fixed = true});
  hc::Parameter<double> salience =
      module.parameter("salience", 0.9, "", "of the bid", {.min = 0, .max = 1});
  hc::Parameter<double> focal =
      module.parameter("focal", hc::vision::kUnknownFocal, "px",
                       "focal length of the eyes, without a file; 0: unknown, the images' width "
                       "is assumed",
                       {.min = 0, .max = 1e6, .fixed = true});
  hc::Parameter<double> timeout =
      module.parameter("timeout", 5.0, "s", "to wait for the head to rest where it is sent",
                       {.min = 0.5, .max = 600});
  hc::Parameter<double> pause =
      module.parameter("pause", 30.0, "s", "after a failed attempt", {.min = 0});
  hc::Parameter<std::int64_t> tries =
      module.parameter("tries", 3, "", "failed attempts until it gives up", {.min = 1});
};

class Calibrator {
 public:
  /// @param module  must outlive it.
  explicit Calibrator(hc::Module& module);
  ~Calibrator() { computation_.stop.request_stop(); }
  Calibrator(const Calibrator&) = delete;
  Calibrator& operator=(const Calibrator&) = delete;

  /// For the end of the program.
  void log_result() const;

 private:
  struct Found {
    hc::gaze::HeadCalibration calibration;
    std::string how;  ///< for log_result()
  };
  /// On another thread.
  struct Computation {
    std::stop_source stop;
    std::future<hc::Result<hc::gaze::HeadCalibration>> result;  ///< valid while it runs
  };
  struct Attempts {
    hc::Time sent;  ///< when the current pose was first commanded; Time{}: not yet
    hc::Time paused_until;
    std::int64_t failed = 0;
    bool are_over = false;
  };

  void start();
  /// Handles a pair of images and the head's pose at its time.
  void look(hc::Time time, const hc::gaze::Angles& measured, const hc::Message& one,
            const hc::Message& other);
  void compute();
  /// Takes the result of the computation.
  void take();
  /// Bids for the head, and turns it.
  void steer();
  /// @param how  begins the line of the log; "": by turning the head.
  void finish(const hc::gaze::HeadCalibration& calibration, const std::string& how);
  void fail(const std::string& why);
  void publish();
  [[nodiscard]] bool computes() const { return computation_.result.valid(); }

  hc::Module& module_;
  hc::Input<hc::RgbImageKind<std::uint8_t>> left_ =
      module_.input("left", hc::rgb_image().in(hc::Coord::kLeftImage), "image of the left camera");
  hc::Input<hc::RgbImageKind<std::uint8_t>> right_ =
      module_.input("right", hc::rgb_image().in(hc::Coord::kRightImage), "of the right one");
  hc::Output<hc::RotationKind<double>> command_ =
      module_.output("command", hc::rotation().in(hc::Coord::kGaze),
                     "commanded head orientation: roll 0, tilt, pan [rad]");
  hc::Output<hc::TableKind<double>> bid_ =
      module_.output("bid", hc::table(), "while it looks, else 0", {.columns = {"salience"}});
  hc::Output<hc::TableKind<double>> result_ = module_.output(
      "result", hc::table().of(1, 7),
      "whether the eyes are swapped, the left eye with the unit at 0, the right eye "
      "to the left one, RMS of the distance from epipolar lines; once a second",
      {.columns = {"swapped", "left pan [rad]", "left tilt [rad]", "right roll [rad]",
                   "right pitch [rad]", "right yaw [rad]", "RMS [px]"}});
  const CalibratorParameters parameters_{module_};
  hc::ModuleFrames frames_{module_};

  hc::vision::AssumedCameras assumed_{module_, "the mounting found may be wrong",
                                      "set calibration_file or focal"};
  std::optional<Tour> tour_;  // this and `mounted_` from the start
  std::optional<hc::gaze::Eyes> mounted_;
  hc::vision::StereoCalibration cameras_;              // set once the images' size is known
  std::optional<hc::vision::StereoCalibration> read_;  // the file at the start, if any
  Computation computation_;
  std::optional<Found> found_;
  Attempts attempts_;
  hc::Time last_pair_;  // last images of both eyes with a known head pose
};
