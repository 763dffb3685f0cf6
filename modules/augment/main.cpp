// SPDX-License-Identifier: Apache-2.0
// Objects that are not there, in the images of both eyes.
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <vision/messages.h>

#include "instruments.h"
#include "scene.h"

namespace {

using hc::Coord;
using Image = decltype(hc::rgb_image<std::uint8_t>());

constexpr std::int64_t kTargetLives = 500'000'000;  // a target is shown for so long [ns]

hc::AnyKind image(std::int32_t rectified, std::int32_t raw) {
  return hc::any_of(hc::rgb_image<std::uint8_t>().in(rectified),
                    hc::rgb_image<std::uint8_t>().in(raw));
}

/// What the gaze follows: a pixel of an image, or a place in a frame [m].
struct Target {
  std::int64_t time = 0;
  std::int32_t coord = 0;
  Eigen::Vector3d p;
};

/// "1.53 m, sure 80 %".
std::string words_at(const cv::Point& pixel, const cv::Mat& depth, const cv::Mat& confidence) {
  char words[64] = "";
  int length = 0;
  const auto add = [&](const char* format, double value) {
    length += std::snprintf(words + length, sizeof words - static_cast<std::size_t>(length), format,
                            value);
  };
  if (!depth.empty()) {
    const double metres = depth.at<float>(pixel);
    if (metres > 0)
      add("%.2f m ", metres);
    else
      add("unknown%.0s ", 0);
  }
  if (!confidence.empty()) add("sure %.0f %%", confidence.at<std::uint8_t>(pixel) / 2.55);
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"augment", "Draws objects into the images of both eyes, hidden by what is "
                               "before them."};
  auto left = module.input("left", image(Coord::kLeftRectified, Coord::kLeftImage),
                           "image of the left eye, without distortion");
  auto right = module.input("right", image(Coord::kRightRectified, Coord::kRightImage),
                            "image of the right eye");
  auto depth = module.input("depth", hc::intensity_image<float>().in(Coord::kDepth),
                            "of the left image [m], 0 unknown");
  auto intrinsics = module.input("intrinsics", hc::table<double>(),
                                 "fx, fy, cx, cy [px], baseline [m] of the pair, from rectify; "
                                 "until then focal and the frames apply");
  auto cameras = module.input("cameras", hc::transformation<double>(4, 4),
                              "how the eyes sit on the head, from rectify; until then as the frames "
                              "have it");
  auto poses = module.input("poses", hc::transformation<double>(4, 4),
                            "T_eye_marker, from marker: objects in the markers' frames follow");
  auto target = module.input("target", hc::position<double>().finite(),
                             "what the gaze follows, for the instrument gaze: x, y in the left (7) "
                             "or right (8) image [px], or a place in any frame [m]");
  auto confidence = module.input("confidence", hc::intensity_image<std::uint8_t>(),
                                 "of the depth, for the instrument confidence");
  auto left_out = module.output("left", hc::rgb_image<std::uint8_t>(), "the left image, augmented");
  auto right_out =
      module.output("right", hc::rgb_image<std::uint8_t>(), "the right image, augmented");
  auto corners = module.output("corners", hc::table<double>(),
                               "8 rows an object, the corners of the box around it: x, y in the "
                               "left and x, y in the right image [px], NaN behind the eye");
  auto mask = module.output("mask", hc::intensity_image<std::uint8_t>(),
                            "of the left image: 255 where an object alone is seen, 0 none");
  module.on_demand(corners);
  module.on_demand(mask);
  auto objects = module.parameter("objects", "cube at world 2 0 1.2 size 0.3", "",
                                  "MODEL at FRAME [X Y Z [ROLL PITCH YAW]] [size SIZE], with ; "
                                  "between them: cube, ball or a file of .obj, .stl, .gltf, .glb; a "
                                  "frame by name, or the number of a frame or marker; m, degrees");
  auto smoothing = module.parameter("smoothing", 0.2, "s", "time constant of markers' poses",
                                    {.min = 0, .max = 10});
  auto shown = module.parameter("instruments", "", "",
                                "to be shown: gaze, frames, depth, confidence, task");
  auto tasks = module.parameter("tasks", "", "", "names of modes, e.g. \"track=4 read=5\"");
  auto cursor_x = module.parameter("cursor_x", -1.0, "px", "where depth is shown, -1: the middle",
                                   {.min = -1, .max = 65535});
  auto cursor_y = module.parameter("cursor_y", -1.0, "px", "the same, from the top",
                                   {.min = -1, .max = 65535});
  auto focal = module.parameter("focal", 800.0, "px", "focal length", {.min = 1e-3, .max = 1e6});
  hc::ModuleFrames frames{module};

  std::unique_ptr<Scene> scene;
  Instruments instruments;
  std::map<int, std::string> names;
  std::optional<std::string> objects_read, shown_read, tasks_read;
  Pair pair;
  Markers markers;
  std::optional<Target> followed;
  std::optional<hc::Message> sureness;

  auto read_parameters = [&] {
    // They may be set while the module runs.
    if (objects_read != *objects) {
      scene.reset();  // before another one makes its context current
      scene = hc::value_or_end(Scene::make(*(objects_read = *objects)));
    }
    if (shown_read != *shown) instruments = hc::value_or_end(read_instruments(*(shown_read = *shown)));
    if (tasks_read != *tasks) names = hc::value_or_end(read_tasks(*(tasks_read = *tasks)));
  };
  /// The eyes at a time, T_world_eye of the left and the right one.
  auto eyes_at = [&](std::int64_t time) {
    const auto pose = [&](std::string_view frame) {
      auto known = frames.lookup("world", frame, time);
      return known ? *known : frames.nearest("world", frame, time);
    };
    std::array<Eigen::Isometry3d, 2> eyes;
    eyes[0] = (pair.T_head_left ? pose("head") * *pair.T_head_left : pose("left_eye")) *
              pair.T_left_rectified;
    eyes[1] = eyes[0] * Eigen::Translation3d(pair.baseline, 0, 0);
    return eyes;
  };
  auto sight_at = [&](const hc::Header& header) {
    if (pair.baseline == 0) pair.baseline = frames.fixed("left_eye", "right_eye").translation().norm();
    Sight sight;
    sight.camera.width = header.width;
    sight.camera.height = header.height;
    const bool is_known = pair.fx > 0;
    sight.camera.fx = is_known ? pair.fx : *focal;
    sight.camera.fy = is_known ? pair.fy : *focal;
    sight.camera.cx = is_known ? pair.cx : (header.width - 1) / 2.0;
    sight.camera.cy = is_known ? pair.cy : (header.height - 1) / 2.0;
    sight.T_world_eye = eyes_at(header.time);
    sight.scale = sight.camera.fx * pair.baseline;
    return sight;
  };
  auto send_corners = [&](const Sight& sight, std::int64_t time) {
    const auto& bodies = scene->bodies();
    auto draft = corners.loan(4, static_cast<std::int32_t>(8 * bodies.size()));
    draft.header.time = time;
    auto number = draft.numbers().begin();
    for (const auto& body : bodies)
      for (const auto& corner : body.corners())
        for (const auto& T_world_eye : sight.T_world_eye) {
          const Eigen::Vector3d p = T_world_eye.inverse() * corner;
          const Eigen::Vector2d pixel =
              p.z() > 0 ? sight.camera.project(p) : Eigen::Vector2d::Constant(std::nan(""));
          *number++ = pixel.x();
          *number++ = pixel.y();
        }
    corners.send(std::move(draft));
  };
  auto draw_target = [&](const Sight& sight, std::size_t eye, std::int64_t time, cv::Mat& mat) {
    if (!followed || std::abs(time - followed->time) > kTargetLives) return;
    const bool is_left = followed->coord == Coord::kLeftImage || followed->coord == Coord::kLeftRectified;
    const bool is_right = followed->coord == Coord::kRightImage || followed->coord == Coord::kRightRectified;
    if (is_left || is_right) {
      if (is_left == (eye == 0)) draw_ring(mat, followed->p.head<2>(), "gaze");
      return;
    }
    const auto T_world_frame = frames.tree().nearest("world", followed->coord, time);
    if (!T_world_frame) return;
    const Eigen::Vector3d p = sight.T_world_eye.at(eye).inverse() * *T_world_frame * followed->p;
    if (p.z() > sight.camera.near) draw_ring(mat, sight.camera.project(p), "gaze");
  };
  auto draw_instruments = [&](const Sight& sight, std::size_t eye, std::int64_t time,
                              const cv::Mat& metres, cv::Mat& mat) {
    const Eigen::Isometry3d T_eye_world = sight.T_world_eye.at(eye).inverse();
    if (instruments.frames) {
      for (const auto& name : frames.tree().names())
        if (const auto T_world_frame = frames.tree().nearest("world", std::string_view(name), time); T_world_frame)
          draw_axes(mat, sight.camera, T_eye_world * *T_world_frame, name);
      for (const auto& body : scene->bodies())
        draw_axes(mat, sight.camera, T_eye_world * body.T_world_body, "");
    }
    if (instruments.gaze) draw_target(sight, eye, time, mat);
    if (eye == 0 && (instruments.depth || instruments.confidence)) {
      cv::Mat sure;
      if (instruments.confidence && sureness) sure = hc::value_or_end(hc::as_mat(*sureness));
      if (sure.size() != metres.size()) sure.release();
      const cv::Point at(
          std::min(static_cast<int>(*cursor_x < 0 ? (mat.cols - 1) / 2.0 : *cursor_x), mat.cols - 1),
          std::min(static_cast<int>(*cursor_y < 0 ? (mat.rows - 1) / 2.0 : *cursor_y), mat.rows - 1));
      draw_cross(mat, {at.x, at.y}, words_at(at, instruments.depth ? metres : cv::Mat(), sure));
    }
    if (instruments.task) {
      const auto focus = module.focus();
      const auto name = names.find(focus);
      draw_title(mat, "task: " + (name != names.end() ? name->second
                                  : focus == 0        ? std::string("none")
                                                      : std::to_string(focus)));
    }
  };
  /// Sends an image with all that is to be seen in it, or as it is.
  auto send = [&](const Sight& sight, std::size_t eye, const hc::Message& taken,
                  const hc::Message& metres, auto& output) {
    const bool masks = eye == 0 && mask.linked();
    if (!output.linked() && !masks) return;
    if (!masks && !instruments.any() && !scene->is_seen(sight)) return output.send({taken});
    auto draft = output.loan(taken.header.width, taken.header.height);
    draft.header.time = taken.header.time;
    draft.header.coord = taken.header.coord;
    std::ranges::copy(taken.elements, draft.elements().begin());
    cv::Mat mat = hc::as_mat(draft);
    const cv::Mat far = hc::value_or_end(hc::as_mat(metres));
    std::optional<decltype(mask.loan(0, 0))> seen;
    cv::Mat seen_mat;
    if (masks) {
      seen.emplace(mask.loan(taken.header.width, taken.header.height));
      seen->header.time = taken.header.time;
      seen->header.coord = taken.header.coord;
      seen_mat = hc::as_mat(*seen);
      seen_mat = 0;
    }
    if (auto drawn = scene->draw(sight, eye, far, mat, masks ? &seen_mat : nullptr); !drawn)
      throw hc::ModuleError(drawn.error());
    if (instruments.any()) draw_instruments(sight, eye, taken.header.time, far, mat);
    output.send(std::move(draft));
    if (seen) mask.send(std::move(*seen));
  };

  module.on_start(read_parameters);
  module.on(intrinsics, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    const bool is_pair = numbers.size() == 5 && hc::finite(numbers) && numbers[0] > 0 &&
                         numbers[1] > 0 && numbers[4] > 0;
    if (!is_pair)
      return module.log_once("invalid intrinsics",
                             "intrinsics: not fx, fy, cx, cy, baseline of a pair");
    pair.fx = numbers[0];
    pair.fy = numbers[1];
    pair.cx = numbers[2];
    pair.cy = numbers[3];
    pair.baseline = numbers[4];
  });
  module.on(cameras, [&](const auto& message) {
    const auto pose = hc::pose_of(message);
    if (!pose) return module.log_once("invalid cameras", "cameras: " + pose.error().detail);
    if (pose->from == Coord::kLeftRectified)
      pair.T_left_rectified = pose->T_to_from;
    else if (pose->from == Coord::kLeftEye && pose->to == Coord::kHead)
      pair.T_head_left = pose->T_to_from;
  });
  module.on(poses, [&](const auto& message) {
    // A marker without a frame has no number by which an object could name it.
    const auto pose = hc::pose_of(message);
    if (!pose) return;
    frames.when_known("world", pose->to, pose->time, [&, pose](const auto& T_world_eye) {
      const auto T = T_world_eye ? *T_world_eye : frames.nearest("world", pose->to, pose->time);
      markers.see(pose->from, pose->time, T * pose->T_to_from, *smoothing);
    });
  });
  module.on(target, [&](const auto& message) {
    const auto numbers = message.numbers();
    if (numbers.size() >= 3)
      followed = Target{message.header.time, message.header.coord, {numbers[0], numbers[1], numbers[2]}};
  });
  module.on(confidence, [&](const auto& message) { sureness = message.keep(); });
  module.on(hc::together(left, right, depth), [&](const hc::Message& left_image,
                                                  const hc::Message& right_image,
                                                  const hc::Message& metres) {
    const auto &l = left_image.header, &r = right_image.header, &d = metres.header;
    if (l.width != r.width || l.height != r.height || l.width != d.width || l.height != d.height)
      throw hc::ModuleError("the images and the depth have different sizes");
    if (l.empty()) return;
    const auto draw = [&, l_image = left_image.keep(), r_image = right_image.keep(),
                       kept = metres.keep()](const auto&) {
      read_parameters();
      const Sight sight = sight_at(l_image.header);
      scene->place(frames, markers, l_image.header.time);
      if (corners.linked()) send_corners(sight, l_image.header.time);
      send(sight, 0, l_image, kept, left_out);
      send(sight, 1, r_image, kept, right_out);
    };
    frames.when_known("world", "left_eye", l.time, draw);
  });
  module.on_end([&] { frames.answer_all(); });
  module.background();
  return module.run(argc, argv);
}
