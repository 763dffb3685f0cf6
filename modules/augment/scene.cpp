// SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include <algorithm>
#include <cmath>

#include <graphics/occlusion.h>
#include <hc/base/clock.h>

namespace {

/// T_world_frame; nothing for a marker not yet seen.
std::optional<Eigen::Isometry3d> find_frame(hc::ModuleFrames& frames, const Markers& markers,
                                            const NamedFrame& frame, hc::Time time) {
  if (frame.number == 0) return frames.nearest("world", std::string_view(frame.name), time);
  if (const auto* T_world_marker = markers.find(frame.number); T_world_marker != nullptr)
    return *T_world_marker;
  const auto known = frames.tree().nearest("world", frame.number, time);
  return known ? std::optional(*known) : std::nullopt;
}

}  // namespace

void Markers::see(int number, hc::Time time, const Eigen::Isometry3d& T_world_marker,
                  double smoothing) {
  constexpr double kMoved = 0.1;  // a larger jump is not smoothed [m]
  const auto [at, is_new] = seen_.try_emplace(number, Seen{time, T_world_marker});
  if (is_new) return;
  auto& [last, pose] = at->second;
  const double passed = hc::seconds(time - last);
  const bool is_moved = (pose.translation() - T_world_marker.translation()).norm() > kMoved;
  const double share =
      is_moved || smoothing <= 0 || passed < 0 ? 1 : 1 - std::exp(-passed / smoothing);
  using hc::frames::Pose;
  pose = between(Pose(pose), Pose(T_world_marker), share).transformation();
  last = time;
}

const Eigen::Isometry3d* Markers::find(int number) const {
  const auto at = seen_.find(number);
  return at == seen_.end() ? nullptr : &at->second.pose;
}

hc::Result<std::unique_ptr<Scene>> Scene::make(const std::string& text,
                                               std::unique_ptr<hc::graphics::Renderer> renderer) {
  auto objects = HC_TRY(read_objects(text));
  std::unique_ptr<Scene> scene(new Scene(std::move(renderer)));
  for (const auto& object : objects) {
    auto parts = HC_TRY(load(object.model));
    scene->bodies_.push_back(hc::graphics::make_body(*scene->renderer_, parts));
    if (object.size > 0) scene->bodies_.back().set_size(object.size);
  }
  scene->objects_ = std::move(objects);
  return scene;
}

void Scene::place(hc::ModuleFrames& frames, const Markers& markers, hc::Time time) {
  placed_.clear();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Object& object = objects_[i];
    hc::graphics::Body body = bodies_[i];
    auto T_world_frame = find_frame(frames, markers, object.frame, time);
    if (!T_world_frame) continue;
    if (object.other) {
      const auto T_world_other = find_frame(frames, markers, *object.other, time);
      if (!T_world_other) continue;
      const Eigen::Vector3d from = T_world_frame->translation(), to = T_world_other->translation();
      if (from == to) continue;  // no direction
      T_world_frame = between_points(from, to);
      if (object.fits) body.set_size((to - from).norm());
    }
    body.T_world_body = *T_world_frame * object.T_frame_object;
    placed_.push_back(std::move(body));
  }
}

bool Scene::is_seen(const Sight& sight) const {
  const auto is_body_seen = [&](const auto& body) {
    return std::ranges::any_of(sight.T_world_eye, [&](const auto& T_world_eye) {
      return !hc::graphics::part_of(body, sight.camera, T_world_eye).empty();
    });
  };
  return std::ranges::any_of(placed_, is_body_seen) ||
         std::ranges::any_of(tags_.bodies(), is_body_seen);
}

std::vector<double> Scene::corners(const Sight& sight) const {
  std::vector<double> numbers;
  for (const auto& body : placed_)
    for (const auto& corner : body.corners())
      for (const std::size_t eye : {0U, 1U}) {
        const Eigen::Vector3d p = sight.in_eye(eye, corner);
        const Eigen::Vector2d pixel =
            p.z() > 0 ? sight.camera.project(p) : Eigen::Vector2d::Constant(std::nan(""));
        numbers.insert(numbers.end(), {pixel.x(), pixel.y()});
      }
  return numbers;
}

hc::Status Scene::draw(const Sight& sight, std::size_t eye, const cv::Mat& depth, cv::Mat& image,
                       cv::Mat* mask) {
  hc::graphics::Overlay::View view;
  view.camera = sight.camera;
  view.T_world_camera = sight.T_world_eye.at(eye);
  view.scale = sight.scale;
  view.nearness = [&](const cv::Rect& part, cv::Mat& nearness) {
    hc::graphics::nearness_of(eye == 1, depth, sight.scale, part, nearness);
  };
  auto all = placed_;
  all.insert(all.end(), tags_.bodies().begin(), tags_.bodies().end());
  return overlay_.draw(all, view, image, mask);
}
