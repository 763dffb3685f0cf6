// SPDX-License-Identifier: Apache-2.0
#include "hands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <hc/base/table_row.h>
#include <nets/weights.h>
#include <people/hand_place.h>
#include <vision/messages.h>

using hc::rounded;
using hc::people::Hand;
using hc::people::Sign;

namespace {

/// How long the depth of a hand stays about the same.
constexpr std::chrono::milliseconds kDepthLives{500};

/// A network, of a file that was set or installed.
template <typename Finder>
Finder read(const hc::Parameter<std::string>& file, const std::string& installed) {
  const auto path = file->empty() ? hc::nets::weights_path(installed) : *file;
  return hc::value_or_refuse(
      file, Finder::make(hc::value_or_refuse(file, hc::nets::Network::read(path))));
}

hc::vision::Pinhole lens_of(const hc::vision::PairIntrinsics& pair) {
  return {pair.fx, pair.fy, pair.cx, pair.cy};
}

}  // namespace

Hands::Hands(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(left_, [this](const hc::Image& image) {
    frames_.when_known("robot", "head", module_.time_of(image.header),
                       [this, kept = image.keep()](const auto&) { see_left(kept); });
  });
  module.on_end([this] { frames_.answer_all(); });
  module.on(right_, [this](const hc::Image& image) { see_right(image); });
  module.on(depth_, [this](const hc::Message& depth) { see_depth(depth); });
  module.on(cameras_, [this](const hc::Message& message) {
    mount_.take(hc::value_or_drop(hc::pose_of(message)));
  });
  module.on(faces_, [this](const hc::MessageOf<hc::TableKind<double>>& faces) {
    seen_faces_.take(module_.time_of(faces.header), faces.matrix());
  });
}

void Hands::start() {
  using hc::people::HandLandmarks, hc::people::PalmFinder;
  search_.emplace(read<PalmFinder>(palms_, "palm_detection_lite.tflite"),
                  read<HandLandmarks>(landmarks_, "hand_landmark_lite.tflite"));
}

void Hands::see_left(const hc::Message& message) {
  const auto tracks = look(message);
  last_ = module_.time_of(message.header);
  pointing_.reset();
  for (const auto& track : tracks)
    if (update_hold(track) && !pointing_) pointing_ = track;
  if (!right_.linked()) return aim(nullptr);
  if (const auto* right = rights_.find(last_)) aim(right);
}

void Hands::see_right(const hc::Message& message) {
  if (!left_.linked()) {
    for (const auto& track : look(message)) update_hold(track);
  } else if (module_.time_of(message.header) == last_) {
    aim(&message);
  } else {
    rights_.add(message.keep());
  }
}

std::vector<hc::people::HandTrack> Hands::look(const hc::Message& message) {
  search_->set_most(static_cast<std::size_t>(*most_));
  size_ = {message.header.width, message.header.height};
  const cv::Mat image = hc::value_or_drop(hc::as_mat(message));
  const auto time = module_.time_of(message.header);
  std::optional<std::vector<cv::Rect2f>> faces;
  if (faces_.linked()) faces = seen_faces_.boxes(time);
  auto tracks = search_->look(time, image, faces);
  send(message.header, tracks);
  return tracks;
}

void Hands::send(const hc::Header& image, const std::vector<HandTrack>& tracks) {
  auto draft = hands_.loan(static_cast<std::int32_t>(tracks.size()), hc::people::kHandColumns);
  draft.header.time = image.time;
  draft.header.coord = image.coord;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto& [number, hand, seen] = tracks[i];
    write(hc::people::HandRow{number, hand.side, hand.presence, hc::people::sign_of(hand),
                              hand.points},
          draft.matrix().row(i));
  }
  hands_.send(std::move(draft));
}

bool Hands::update_hold(const HandTrack& track) {
  std::erase_if(holdings_, [&](const auto& each) {
    return std::chrono::abs(track.seen - each.second.seen) > hc::people::SignHold::kSilence;
  });
  auto& [hold, command, seen] = holdings_[track.number];
  seen = track.seen;
  const Sign sign = hc::people::sign_of(track.hand);
  if (const auto held = hold.update(track.seen, sign))
    sign_.send({static_cast<double>(*held), static_cast<double>(track.number)}, track.seen);
  command.update(track.seen, sign,
                 sign == Sign::None ? std::nullopt : std::optional(seen_at(track)));
  if (const auto word = stop_words_.update(module_.monotonic(), command.held()))
    stop_.send({*word}, module_.now());
  return hold.held() == Sign::Point;
}

hc::people::HandCommand::Directions Hands::seen_at(const HandTrack& track) {
  const auto cameras = pair();
  const Eigen::Matrix3d R_robot_camera = mount_.pose_in("robot", track.seen, frames_).linear();
  const auto to = [&](Hand::Point point) -> Eigen::Vector3d {
    const auto& p = track.hand.points[point];
    const Eigen::Vector3d ray((p.x - cameras.cx) / cameras.fx, (p.y - cameras.cy) / cameras.fy, 1);
    return R_robot_camera * ray.normalized();
  };
  return {to(Hand::Wrist), to(Hand::Middle), to(Hand::MiddleTip)};
}

void Hands::aim(const hc::Message* right) {
  if (!pointing_ || pair_.is_awaited()) return;
  const HandTrack track = *std::exchange(pointing_, std::nullopt);
  const auto joints = joints_of(track, right);
  if (!joints) return;
  const auto T = T_head_camera(track.seen);
  const auto eyes = seen_faces_.eyes_near(track.seen, (*joints)[Hand::IndexTip], T);
  const auto ray = hc::people::pointing_ray(*joints, eyes);
  aims_.add({track.seen, ray});
  const Eigen::Vector3d from = T * ray.from, direction = T.linear() * ray.direction;
  std::vector<double> numbers;
  for (const auto& part : {from, direction})
    for (const double each : part) numbers.push_back(rounded(each));
  numbers.push_back(ray.is_from_eye ? 1 : 0);
  ray_.send(numbers, track.seen);
}

std::optional<hc::people::Joints> Hands::joints_of(const HandTrack& track,
                                                   const hc::Message* right) {
  const auto cameras = pair();
  const auto by_size = hc::people::joints_of(track.hand, lens_of(cameras));
  if (!by_size) return std::nullopt;
  std::optional<double> depth;
  if (last_depth_ &&
      std::chrono::abs(module_.time_of(last_depth_->header) - track.seen) < kDepthLives)
    depth = hc::people::depth_in(*hc::as_mat(*last_depth_), track.hand);
  if (right) {
    const double disparity =
        cameras.fx * cameras.baseline / depth.value_or(hc::people::depth_of(*by_size));
    const Hand other = search_->look_at(hc::value_or_drop(hc::as_mat(*right)),
                                        hc::people::region_in_right(track.hand, disparity));
    if (other.presence >= hc::people::kHandIsThere)
      if (auto by_eyes =
              hc::people::joints_by_eyes(track.hand, other, lens_of(cameras), cameras.baseline))
        return by_eyes;
  }
  return depth ? hc::people::moved_to(*by_size, *depth) : by_size;
}

void Hands::see_depth(const hc::Message& message) {
  const cv::Mat metres = hc::value_or_drop(hc::as_mat(message));
  last_depth_ = message.keep();
  const auto time = module_.time_of(message.header);
  if (const auto aim = aims_.take(time)) {
    const auto T = mount_.pose_in("robot", aim->time, frames_);
    steady_.add(
        {aim->time, {T * aim->ray.from, T.linear() * aim->ray.direction, aim->ray.is_from_eye}});
    if (const auto steady = steady_.find()) aim_ = steady;
  }
  if (!aim_ || std::chrono::abs(time - aim_->time) > kAimLives) return;
  const auto T_camera_robot = mount_.pose_in("robot", time, frames_).inverse();
  const hc::people::Ray ray{T_camera_robot * aim_->ray.from,
                            T_camera_robot.linear() * aim_->ray.direction, aim_->ray.is_from_eye};
  const Eigen::Vector3d place = hc::people::place_pointed_at(ray, metres, lens_of(pair()))
                                    .value_or(ray.from + kAhead * ray.direction);
  const Eigen::Vector3d p = T_head_camera(time) * place;
  target_.send({rounded(p.x()), rounded(p.y()), rounded(p.z())}, time);
}
