// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds hands in the images of one eye or both, their signs, and where they point to.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <people/face_table.h>
#include <people/hand_command.h>
#include <people/hand_search.h>
#include <people/hand_table.h>
#include <people/sign.h>
#include <vision/module_cameras.h>
#include <vision/right_images.h>

#include "aims.h"
#include "palm_stop.h"
#include "seen_faces.h"

class Hands {
 public:
  /// @param module  must outlive it.
  explicit Hands(hc::Module& module);

 private:
  using HandTrack = hc::people::HandTrack;
  /// How long a place is looked for that was pointed at, while the head turns there.
  static constexpr std::chrono::milliseconds kAimLives{2000};
  /// Where to look for it along the ray as long as it is not in the image. [m]
  static constexpr double kAhead = 1.5;
  struct Holding {
    hc::people::SignHold hold{hc::people::SignHold::kHold, hc::people::SignHold::kLongGap};
    hc::people::HandCommand command;
    hc::Time seen;
  };

  void start();
  /// Looks at a left image, once it is known how the head was turned then.
  void see_left(const hc::Message& message);
  void see_right(const hc::Message& message);
  void see_depth(const hc::Message& message);
  /// Finds hands, and sends them and their signs.
  std::vector<HandTrack> look(const hc::Message& message);
  void send(const hc::Header& image, const std::vector<HandTrack>& tracks);
  /// Sends a sign that has been held. @returns whether the hand points now.
  bool update_hold(const HandTrack& track);
  /// The directions of a hand, in the robot's frame.
  [[nodiscard]] hc::people::HandCommand::Directions seen_at(const HandTrack& track);
  /// Sends the ray of the hand that points. @param right  null: not seen by the right eye.
  void aim(const hc::Message* right);
  [[nodiscard]] std::optional<hc::people::Joints> joints_of(const HandTrack& track,
                                                            const hc::Message* right);
  [[nodiscard]] hc::vision::PairIntrinsics pair() { return pair_.of(size_.width, size_.height); }
  [[nodiscard]] Eigen::Isometry3d T_head_camera(hc::Time time) {
    return mount_.pose_in("head", time, frames_);
  }

  hc::Module& module_;
  hc::Input<hc::ImageKind> left_ = module_.input(
      "left", hc::image(), "left image, best rectified: hands are found in it", {.keep = 1});
  hc::Input<hc::ImageKind> right_ =
      module_.input("right", hc::image(),
                    "right image of the rectified pair, for places; without left, hands are found "
                    "in it",
                    {.keep = 1});
  hc::Input<hc::IntensityImageKind<float>> depth_ =
      module_.input("depth", hc::intensity_image<float>().in(hc::Coord::kDepth),
                    "depth of the left image's pixels [m], 0 unknown, from depth", {.keep = 1});
  hc::Input<hc::TransformationKind<double>> cameras_ =
      module_.input("cameras", hc::transformation(),
                    "mounting of the eyes on the head, from rectify; until then from the frames");
  hc::Input<hc::TableKind<double>> faces_ =
      module_.input("faces", hc::table().of(0, hc::people::kFaceColumns),
                    "faces in the left image, from faces: people aim with their eyes", {.keep = 1});
  hc::Output<hc::TableKind<double>> hands_ = module_.output(
      "hands", hc::table(),
      "a row for each hand, in the coordinate system of the image; side: 0 left, 1 right; sign: 0 "
      "none, 1 open and up, 2 fist, 3 point, 4 victory, 5 thumb up",
      {.columns = hc::people::hand_columns()});
  hc::Output<hc::TableKind<double>> sign_ =
      module_.output("sign", hc::table().of(1, 2), "a sign, once it has been held for 0.3 s",
                     {.columns = {"sign", "track"}});
  hc::Output<hc::TableKind<std::uint8_t>> stop_ = module_.output(
      "stop", hc::table<std::uint8_t>().of(1, 1),
      "1 when an open palm has been held up, and still, for 0.5 s; 0 when, after that, a thumb has",
      {.keep = 4});
  hc::Output<hc::PositionKind<double>> target_ = module_.output(
      "target", hc::position().of(1, 1).in(hc::Coord::kHead),
      "the place that a hand points at, or before that is in sight one in its direction; while it "
      "points, and 2 s after",
      {.columns = {"x [m]", "y [m]", "z [m]"}});
  hc::Output<hc::TableKind<double>> ray_ = module_.output(
      "ray", hc::table().of(1, 7).in(hc::Coord::kHead),
      "the tip of the finger that points, and its direction; by_eye: 1 in a line with the eye, 0 "
      "that of the finger",
      {.columns = {"x [m]", "y [m]", "z [m]", "direction x", "direction y", "direction z",
                   "by_eye"}});
  hc::Parameter<std::string> palms_ = module_.parameter(
      "palms", "", "", "file of the network that finds palms; \"\": the installed one",
      {.fixed = true});
  hc::Parameter<std::string> landmarks_ = module_.parameter(
      "landmarks", "", "", "file of the network that finds their points; \"\": the installed one",
      {.fixed = true});
  hc::Parameter<std::int64_t> most_ = module_.parameter(
      "most", 2, "", "hands that are followed at most, beside one that is open and up",
      {.min = 1, .max = 8});
  hc::ModuleFrames frames_{module_};
  hc::vision::ModulePair pair_{module_, frames_, "places pointed at have no true scale"};

  hc::vision::RectifiedMount mount_;
  std::optional<hc::people::HandSearch> search_;
  std::map<int, Holding> holdings_;  // by track
  PalmStop stop_words_;
  SeenFaces seen_faces_;
  Aims aims_;
  SteadyAim steady_;
  std::optional<Aim> aim_;             // the last one, in the robot's frame
  std::optional<HandTrack> pointing_;  // in the last left image
  hc::Time last_;                      // left image
  cv::Size size_;                      // of the images
  hc::vision::RightImages rights_;
  std::optional<hc::Message> last_depth_;
};
