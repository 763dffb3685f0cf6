// SPDX-License-Identifier: Apache-2.0
#pragma once
// Augmented reality: draws virtual objects into the images of both eyes.

#include <memory>
#include <optional>
#include <string>

#include <frames/module_frames.h>
#include <hc/contract/mode_names.h>
#include <hc/module/module.h>
#include <people/face_table.h>
#include <vision/module_cameras.h>

#include "instruments.h"
#include "named_faces.h"
#include "objects.h"
#include "pair.h"
#include "panel.h"
#include "scene.h"

struct AugmentInputs {
  hc::Module& module;

  hc::Input<hc::AnyKind> left =
      module.input("left", image(hc::Coord::kLeftRectified, hc::Coord::kLeftImage),
                   "image of the left eye, without distortion");
  hc::Input<hc::AnyKind> right = module.input(
      "right", image(hc::Coord::kRightRectified, hc::Coord::kRightImage), "image of the right eye");
  hc::Input<hc::IntensityImageKind<float>> depth =
      module.input("depth", hc::intensity_image<float>().in(hc::Coord::kDepth),
                   "depth of the left image [m], 0 unknown");
  hc::Input<hc::TransformationKind<double>> cameras =
      module.input("cameras", hc::transformation(),
                   "mounting of the eyes on the head, from rectify; until then from the "
                   "frames");
  hc::Input<hc::TransformationKind<double>> poses =
      module.input("poses", hc::transformation(),
                   "T_eye_marker, from marker: objects in the markers' frames follow");
  hc::Input<hc::PositionKind<double>> target =
      module.input("target", hc::position().finite(),
                   "target of the gaze, for the instrument gaze: x, y in the left (7) "
                   "or right (8) image [px], or a position in any frame [m]",
                   {.keep = 1});
  hc::Input<hc::IntensityImageKind<std::uint8_t>> confidence =
      module.input("confidence", hc::intensity_image(),
                   "confidence of the depth, for the instrument confidence");
  hc::Input<hc::TableKind<double>> faces = module.input(
      "faces", hc::table().of(0, hc::people::kFaceColumns).finite(),
      "faces in the left image, from faces: a tag with the name is over each whose person has one",
      {.keep = 1});
  hc::Input<hc::StringKind> names =
      module.input("names", hc::string(), "lines \"PERSON NAME\", from faces", {.keep = 1});

  /// An image of an eye, rectified or as it was taken.
  static hc::AnyKind image(std::int32_t rectified, std::int32_t raw) {
    return hc::any_of(hc::rgb_image().in(rectified), hc::rgb_image().in(raw));
  }
};

struct AugmentOutputs {
  hc::Module& module;

  hc::Output<hc::RgbImageKind<std::uint8_t>> left =
      module.output("left", hc::rgb_image(), "the left image, augmented");
  hc::Output<hc::RgbImageKind<std::uint8_t>> right =
      module.output("right", hc::rgb_image(), "the right image, augmented");
  hc::Output<hc::TableKind<double>> corners =
      module.output("corners", hc::table(),
                    "8 rows an object, the corners of the box around it in both images, NaN "
                    "behind the eye",
                    {.on_demand = true,
                     .columns = {"left x [px]", "left y [px]", "right x [px]", "right y [px]"}});
  hc::Output<hc::IntensityImageKind<std::uint8_t>> mask = module.output(
      "mask", hc::intensity_image(),
      "of the left image: 255 where an object or tag is visible, else 0", {.on_demand = true});
};

struct AugmentParameters {
  hc::Module& module;

  hc::Parameter<std::string> objects = module.parameter(
      "objects", "cube at world 2 0 1.2 size 0.3", "",
      "MODEL at FRAME [to FRAME] [X Y Z [ROLL PITCH YAW]] [size SIZE|fit], with ; "
      "between them: cube, ball or a file of .obj, .stl, .gltf, .glb (in \" "
      "if its name has spaces); a frame by name, or the number of a frame or marker; m, degrees");
  hc::Parameter<double> smoothing = module.parameter(
      "smoothing", 0.2, "s", "time constant of markers' poses", {.min = 0, .max = 10});
  hc::Parameter<std::string> instruments = module.parameter(
      "instruments", "", "", "overlays shown: gaze, frames, depth, confidence, task");
  hc::Parameter<std::string> modes = module.parameter(
      hc::kModeNames, "", "", "names of modes, e.g. read=5,track=4: set by `hc run`");
  hc::Parameter<double> cursor_x =
      module.parameter("cursor_x", -1.0, "px", "pixel whose depth is shown, -1: the middle",
                       {.min = -1, .max = 65535});
  hc::Parameter<double> cursor_y =
      module.parameter("cursor_y", -1.0, "px", "the same, from the top", {.min = -1, .max = 65535});
};

class Augment {
 public:
  /// @param module  must outlive it.
  explicit Augment(hc::Module& module);

 private:
  using Colours = hc::Output<hc::RgbImageKind<std::uint8_t>>;

  void read_parameters();
  void set_camera(const hc::Message& message);
  void see_marker(const hc::Message& message);
  void see_target(const hc::MessageOf<hc::PositionKind<double>>& message);
  void see_faces(const hc::MessageOf<hc::TableKind<double>>& message);
  void look(const hc::Message& left, const hc::Message& right, const hc::Message& metres);
  void draw(const hc::Message& left, const hc::Message& right, const hc::Message& metres);
  void send_corners(const Sight& sight);
  /// Sends an image with the objects, tags and instruments drawn; unchanged if there are none.
  void send(const Sight& sight, std::size_t eye, const hc::Message& image,
            const hc::Message& metres, Colours& output);

  hc::Module& module_;
  AugmentInputs inputs_{module_};
  AugmentOutputs outputs_{module_};
  const AugmentParameters parameters_{module_};
  hc::ModuleFrames frames_{module_};
  hc::vision::ModulePair intrinsics_{module_, frames_, "objects are drawn in the wrong places"};

  std::unique_ptr<Scene> scene_;
  std::optional<std::string> objects_read_, shown_read_, modes_read_;  // parameters
  Pair pair_;
  Markers markers_;
  NamedFaces faces_;
  Panel panel_;
};
