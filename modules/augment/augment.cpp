// SPDX-License-Identifier: Apache-2.0
#include "augment.h"

#include <algorithm>
#include <utility>

#include <frames/messages.h>
#include <vision/messages.h>

namespace {

/// A draft with the size, time and coordinate system of an image.
template <typename K>
hc::DraftOf<K> like(const hc::Message& image, const hc::Output<K>& output) {
  auto draft = output.loan(image.header.height, image.header.width);
  draft.header.time = image.header.time;
  draft.header.coord = image.header.coord;
  return draft;
}

}  // namespace

Augment::Augment(hc::Module& module) : module_(module) {
  module.on_start([this] { read_parameters(); });
  module.on(inputs_.cameras, [this](const auto& message) { set_camera(message); });
  module.on(inputs_.poses, [this](const auto& message) { see_marker(message); });
  module.on(inputs_.target, [this](const auto& message) { see_target(message); });
  module.on(inputs_.confidence,
            [this](const auto& message) { panel_.confidence = hc::as_mat(message).clone(); });
  module.on(inputs_.faces, [this](const auto& message) { see_faces(message); });
  module.on(inputs_.names,
            [this](const auto& message) { hc::succeed_or_drop(faces_.name(message.text())); });
  module.on(hc::together(inputs_.left, inputs_.right, inputs_.depth),
            [this](const hc::Message& left, const hc::Message& right, const hc::Message& metres) {
              look(left, right, metres);
            });
  module.on_end([this] {
    intrinsics_.answer_all();
    frames_.answer_all();
  });
}

void Augment::read_parameters() {
  const auto& given = parameters_;
  if (objects_read_ != *given.objects) {
    scene_.reset();  // releases its OpenGL context before the next is made current
    auto renderer = hc::value_or_end(hc::graphics::Renderer::make());
    scene_ = hc::value_or_refuse(
        given.objects, Scene::make(*(objects_read_ = *given.objects), std::move(renderer)));
  }
  if (shown_read_ != *given.instruments)
    panel_.shown = hc::value_or_refuse(given.instruments,
                                       read_instruments(*(shown_read_ = *given.instruments)));
  if (modes_read_ != *given.modes)
    panel_.modes =
        hc::value_or_refuse(given.modes, hc::parse_mode_names(*(modes_read_ = *given.modes)));
  panel_.cursor_x = *given.cursor_x;
  panel_.cursor_y = *given.cursor_y;
}

void Augment::set_camera(const hc::Message& message) {
  const auto pose = hc::pose_of(message);
  if (!pose) return module_.log_once("invalid cameras", "cameras: " + pose.error().detail);
  pair_.set_camera(*pose);
}

void Augment::see_marker(const hc::Message& message) {
  // Only markers with a frame have a number that objects can refer to.
  const auto pose = hc::pose_of(message);
  if (!pose) return;
  hc::value_or_drop(frames_.tree().chain("world", pose->to));
  frames_.when_known("world", pose->to, pose->time, [this, pose](const auto& T_world_eye) {
    const auto T = T_world_eye ? *T_world_eye : frames_.nearest("world", pose->to, pose->time);
    markers_.see(pose->from, pose->time, T * pose->T_to_from, *parameters_.smoothing);
  });
}

void Augment::see_target(const hc::MessageOf<hc::PositionKind<double>>& message) {
  const auto p = message.numbers();
  if (p.size() < 3) return;
  panel_.target =
      Panel::Target{module_.time_of(message.header), message.header.coord, {p[0], p[1], p[2]}};
}

void Augment::see_faces(const hc::MessageOf<hc::TableKind<double>>& message) {
  const auto time = module_.time_of(message.header);
  auto faces = NamedFaces::read(message.matrix());
  hc::value_or_drop(frames_.tree().chain("world", "head"));
  frames_.when_known("world", "head", time, [this, time, faces = std::move(faces)](const auto&) {
    faces_.see(time, faces, frames_.nearest("world", "head", time));
  });
}

void Augment::look(const hc::Message& left, const hc::Message& right, const hc::Message& metres) {
  const auto &l = left.header, &r = right.header, &d = metres.header;
  if (l.width != r.width || l.height != r.height || l.width != d.width || l.height != d.height)
    throw hc::BadMessage("the images and the depth have different sizes");
  if (l.empty()) return;
  intrinsics_.when_known(
      [this, l_image = left.keep(), r_image = right.keep(), far = metres.keep()]() mutable {
        const auto time = l_image.header.time;
        frames_.when_known("world", "left_eye", time,
                           [this, l_image = std::move(l_image), r_image = std::move(r_image),
                            far = std::move(far)](const auto&) { draw(l_image, r_image, far); });
      });
}

void Augment::draw(const hc::Message& left, const hc::Message& right, const hc::Message& metres) {
  read_parameters();
  panel_.focus = module_.focus();
  const auto intrinsics = intrinsics_.of(left.header.width, left.header.height);
  const Sight sight = pair_.at(left.header, intrinsics, frames_);
  scene_->place(frames_, markers_, sight.time);
  scene_->tag(faces_.at(sight.time), sight);
  if (outputs_.corners.linked()) send_corners(sight);
  send(sight, 0, left, metres, outputs_.left);
  send(sight, 1, right, metres, outputs_.right);
}

void Augment::send_corners(const Sight& sight) {
  const auto numbers = scene_->corners(sight);
  auto draft = outputs_.corners.loan(static_cast<std::int32_t>(numbers.size() / 4), 4);
  draft.header.time = sight.time;
  std::ranges::copy(numbers, draft.numbers().begin());
  outputs_.corners.send(std::move(draft));
}

void Augment::send(const Sight& sight, std::size_t eye, const hc::Message& image,
                   const hc::Message& metres, Colours& output) {
  const bool masks = eye == 0 && outputs_.mask.linked();
  if (!output.linked() && !masks) return;
  if (!masks && !panel_.shown.any() && !scene_->is_seen(sight)) return output.send({image});
  auto draft = like(image, output);
  std::ranges::copy(image.elements, draft.elements().begin());
  cv::Mat pixels = hc::as_mat(draft), seen;
  const cv::Mat scene_depth = hc::value_or_drop(hc::as_mat(metres));
  if (masks) seen = cv::Mat::zeros(pixels.size(), CV_8U);
  hc::succeed_or_end(scene_->draw(sight, eye, scene_depth, pixels, masks ? &seen : nullptr));
  if (panel_.shown.any()) panel_.draw(sight, eye, *scene_, frames_, scene_depth, pixels);
  output.send(std::move(draft));
  if (!masks) return;
  auto mask_draft = like(image, outputs_.mask);
  hc::fill(mask_draft, seen);
  outputs_.mask.send(std::move(mask_draft));
}
