// SPDX-License-Identifier: Apache-2.0
// Augmented reality: draws virtual objects into the images of both eyes.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/contract/mode_names.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>

#include "instruments.h"
#include "pair.h"
#include "panel.h"
#include "scene.h"

namespace {

using hc::Coord;

hc::AnyKind image(std::int32_t rectified, std::int32_t raw) {
  return hc::any_of(hc::rgb_image().in(rectified),
                    hc::rgb_image().in(raw));
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"augment",
                    "Draws objects into the images of both eyes, with "
                    "occlusion.", {.background = true}};
  auto left = module.input("left", image(Coord::kLeftRectified, Coord::kLeftImage),
                           "image of the left eye, without distortion");
  auto right = module.input("right", image(Coord::kRightRectified, Coord::kRightImage),
                            "image of the right eye");
  auto depth = module.input("depth", hc::intensity_image<float>().in(Coord::kDepth),
                            "depth of the left image [m], 0 unknown");
  auto intrinsics = module.input("intrinsics", hc::table(),
                                 "fx, fy, cx, cy [px], baseline [m] of the pair, from rectify; "
                                 "until then focal and the frames apply");
  auto cameras = module.input("cameras", hc::transformation(),
                              "mounting of the eyes on the head, from rectify; until then from the "
                              "frames");
  auto poses = module.input("poses", hc::transformation(),
                            "T_eye_marker, from marker: objects in the markers' frames follow");
  auto target = module.input("target", hc::position().finite(),
                             "target of the gaze, for the instrument gaze: x, y in the left (7) "
                             "or right (8) image [px], or a position in any frame [m]", {.keep = 1});
  auto confidence = module.input("confidence", hc::intensity_image(),
                                 "confidence of the depth, for the instrument confidence");
  auto left_out = module.output("left", hc::rgb_image(), "the left image, augmented");
  auto right_out =
      module.output("right", hc::rgb_image(), "the right image, augmented");
  auto corners = module.output("corners", hc::table(),
                               "8 rows an object, the corners of the box around it: x, y in the "
                               "left and x, y in the right image [px], NaN behind the eye", {.on_demand = true});
  auto mask = module.output("mask", hc::intensity_image(),
                            "of the left image: 255 where an object is visible, else 0", {.on_demand = true});
  auto objects =
      module.parameter("objects", "cube at world 2 0 1.2 size 0.3", "",
                       "MODEL at FRAME [to FRAME] [X Y Z [ROLL PITCH YAW]] [size SIZE|fit], with ; "
                       "between them: cube, ball or a file of .obj, .stl, .gltf, .glb; a "
                       "frame by name, or the number of a frame or marker; m, degrees");
  auto smoothing = module.parameter("smoothing", 0.2, "s", "time constant of markers' poses",
                                    {.min = 0, .max = 10});
  auto shown = module.parameter("instruments", "", "",
                                "overlays shown: gaze, frames, depth, confidence, task");
  auto modes = module.parameter(hc::kModeNames, "", "",
                                "names of modes, e.g. read=5,track=4: set by `hc run`");
  auto cursor_x =
      module.parameter("cursor_x", -1.0, "px", "pixel whose depth is shown, -1: the middle",
                       {.min = -1, .max = 65535});
  auto cursor_y =
      module.parameter("cursor_y", -1.0, "px", "the same, from the top", {.min = -1, .max = 65535});
  auto focal = module.parameter("focal", 800.0, "px", "focal length", {.min = 1e-3, .max = 1e6});
  hc::ModuleFrames frames{module};

  std::unique_ptr<Scene> scene;
  std::optional<std::string> objects_read, shown_read, modes_read;
  Pair pair;
  Markers markers;
  Panel panel;

  auto read_parameters = [&] {
    if (objects_read != *objects) {
      scene.reset();  // releases its OpenGL context before the next is made current
      scene = hc::value_or_end(Scene::make(*(objects_read = *objects)));
    }
    if (shown_read != *shown)
      panel.shown = hc::value_or_end(read_instruments(*(shown_read = *shown)));
    if (modes_read != *modes)
      panel.modes = hc::value_or_end(hc::parse_mode_names(*(modes_read = *modes)));
    panel.cursor_x = *cursor_x;
    panel.cursor_y = *cursor_y;
  };
  auto send_corners = [&](const Sight& sight) {
    const auto numbers = scene->corners(sight);
    auto draft = corners.loan(static_cast<std::int32_t>(numbers.size() / 4), 4);
    draft.header.time = sight.time;
    std::ranges::copy(numbers, draft.numbers().begin());
    corners.send(std::move(draft));
  };
  /// A draft with the size, time and coordinate system of an image.
  auto like = [](const hc::Message& image, auto& output) {
    auto draft = output.loan(image.header.height, image.header.width);
    draft.header.time = image.header.time;
    draft.header.coord = image.header.coord;
    return draft;
  };
  /// Sends an image with the objects and instruments drawn; unchanged if there are none.
  auto send = [&](const Sight& sight, std::size_t eye, const hc::Message& image,
                  const hc::Message& metres, auto& output) {
    const bool masks = eye == 0 && mask.linked();
    if (!output.linked() && !masks) return;
    if (!masks && !panel.shown.any() && !scene->is_seen(sight)) return output.send({image});
    auto draft = like(image, output);
    std::ranges::copy(image.elements, draft.elements().begin());
    cv::Mat pixels = hc::as_mat(draft), seen;
    const cv::Mat scene_depth = hc::value_or_drop(hc::as_mat(metres));
    if (masks) seen = cv::Mat::zeros(pixels.size(), CV_8U);
    hc::succeed_or_end(scene->draw(sight, eye, scene_depth, pixels, masks ? &seen : nullptr));
    if (panel.shown.any()) panel.draw(sight, eye, *scene, frames, scene_depth, pixels);
    output.send(std::move(draft));
    if (!masks) return;
    auto mask_draft = like(image, mask);
    hc::fill(mask_draft, seen);
    mask.send(std::move(mask_draft));
  };

  module.on_start(read_parameters);
  module.on(intrinsics, [&](const auto& message) {
    if (!pair.set_intrinsics(message.numbers()))
      module.log_once("invalid intrinsics", "intrinsics: not fx, fy, cx, cy, baseline of a pair");
  });
  module.on(cameras, [&](const auto& message) {
    const auto pose = hc::pose_of(message);
    if (!pose) return module.log_once("invalid cameras", "cameras: " + pose.error().detail);
    pair.set_camera(*pose);
  });
  module.on(poses, [&](const auto& message) {
    // Only markers with a frame have a number that objects can refer to.
    const auto pose = hc::pose_of(message);
    if (!pose) return;
    frames.when_known("world", pose->to, pose->time, [&, pose](const auto& T_world_eye) {
      const auto T = T_world_eye ? *T_world_eye : frames.nearest("world", pose->to, pose->time);
      markers.see(pose->from, pose->time, T * pose->T_to_from, *smoothing);
    });
  });
  module.on(target, [&](const auto& message) {
    const auto p = message.numbers();
    if (p.size() < 3) return;
    panel.target = Panel::Target{message.header.time, message.header.coord, {p[0], p[1], p[2]}};
  });
  module.on(confidence,
            [&](const auto& message) { panel.confidence = hc::as_mat(message).clone(); });
  module.on(hc::together(left, right, depth), [&](const hc::Message& left_image,
                                                  const hc::Message& right_image,
                                                  const hc::Message& metres) {
    const auto &l = left_image.header, &r = right_image.header, &d = metres.header;
    if (l.width != r.width || l.height != r.height || l.width != d.width || l.height != d.height)
      throw hc::BadMessage("the images and the depth have different sizes");
    if (l.empty()) return;
    frames.when_known("world", "left_eye", l.time,
                      [&, l_image = left_image.keep(), r_image = right_image.keep(),
                       far = metres.keep()](const auto&) {
                        read_parameters();
                        panel.focus = module.focus();
                        const Sight sight = pair.at(l_image.header, *focal, frames);
                        scene->place(frames, markers, sight.time);
                        if (corners.linked()) send_corners(sight);
                        send(sight, 0, l_image, far, left_out);
                        send(sight, 1, r_image, far, right_out);
                      });
  });
  module.on_end([&] { frames.answer_all(); });
  return module.run(argc, argv);
}
