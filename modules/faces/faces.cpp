// SPDX-License-Identifier: Apache-2.0
#include "faces.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <nets/weights.h>
#include <people/person_name.h>
#include <vision/messages.h>

using hc::people::Track;

namespace {}  // namespace

Faces::Faces(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(left_, [this](const hc::Image& image) {
    intrinsics_.when_known([this, kept = image.keep()] {
      frames_.when_known("robot", "head", module_.time_of(kept.header),
                         [this, kept](const auto&) { look(kept); });
    });
  });
  module.on(right_, [this](const hc::Image& image) {
    if (module_.time_of(image.header) == last_)
      look_right(image);
    else
      rights_.add(image.keep());
  });
  module.on(cameras_, [this](const hc::Message& message) {
    mount_.take(hc::value_or_drop(hc::pose_of(message)));
  });
  module.on(name_, [this](const auto& message) { take_request(message.text()); });
  module.every(std::chrono::seconds(1), [this] {
    read_folder();
    answer_requests();
    forget();
  });
  module.on_end([this] {
    intrinsics_.answer_all();
    frames_.answer_all();
  });
}

void Faces::start() {
  const auto recognition = hc::nets::weights_path("face_recognition.json");
  networks_.emplace(Networks{hc::value_or_end(hc::people::FaceSearch::read()),
                             hc::value_or_end(hc::people::Identifier::make(
                                 hc::value_or_end(hc::nets::Network::read(recognition))))});
  folder_.emplace(*people_, [this](std::string_view line) { module_.log(line); });
  read_folder();
}

void Faces::read_folder() {
  folder_->read();
  std::string lines;
  for (const auto& [name, number] : folder_->gallery().names())
    lines += hc::format("{}{} {}", lines.empty() ? "" : "\n", number, name);
  names_.send(lines, module_.now());
}

void Faces::forget() {
  if (looked_ && module_.monotonic() - *looked_ < hc::people::FaceTracks::kLongest) return;
  for (const NameRequest& request : std::exchange(requests_, {})) refuse(request, "no image comes");
  views_ = {};
  seen_.clear();
  rights_ = {};
}

void Faces::look(const hc::Message& message) {
  const cv::Mat image = hc::value_or_drop(hc::as_mat(message));
  const auto time = module_.time_of(message.header);
  const auto turn = turn_to(message.header);
  last_ = time;
  seen_ = networks_->search.look(time, image, static_cast<float>(*score_), turn);
  describe(time, image, seen_);
  answer_requests();
  send(message.header, seen_);
  if (const auto* right = rights_.find(time)) look_right(*right);
  looked_ = module_.monotonic();
}

cv::Matx33f Faces::turn_to(const hc::Header& image) {
  const auto cameras = intrinsics_.of(image.width, image.height);
  Eigen::Matrix3d K;
  K << cameras.fx, 0, cameras.cx, 0, cameras.fy, cameras.cy, 0, 0, 1;
  const Eigen::Matrix3d R_robot_now = mount_.pose_in("robot", image.time, frames_).linear();
  const Eigen::Matrix3d R_robot_last =
      std::exchange(R_robot_camera_, R_robot_now).value_or(R_robot_now);
  const Eigen::Matrix3f H =
      (K * R_robot_now.transpose() * R_robot_last * K.inverse()).cast<float>();
  cv::Matx33f turn;
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(turn.val) = H;
  return turn;
}

void Faces::describe(hc::Time time, const cv::Mat& image, const std::vector<Track>& seen) {
  const auto due = views_.due(time, seen, networks_->search.expected(time));
  if (!due) return;
  const Track& track = seen[*due];
  if (const auto view = networks_->identifier.describe(image, track.face))
    views_.add(track.number, time, *view);
}

void Faces::look_right(const hc::Message& message) {
  const cv::Mat image = hc::value_or_drop(hc::as_mat(message));
  const auto pair = pair_of(intrinsics_.of(image.cols, image.rows));
  for (const std::size_t place : distances_.due(last_, seen_)) {
    const Track& track = seen_[place];
    const auto box = hc::people::expected_in_right(track.face, pair);
    const auto found = networks_->search.look_around(image, box);
    if (const auto distance = hc::people::distance_by_eyes(track.face, found, pair))
      distances_.add(track.number, last_, *distance);
  }
}

Eigen::Vector3d Faces::place(const hc::Header& image, const Track& track) {
  const auto cameras = intrinsics_.of(image.width, image.height);
  const double z = distances_.find(track.number, last_)
                       .value_or(hc::people::distance_by_size(track.face, pair_of(cameras)));
  const cv::Point2f eyes = track.face.between_eyes();
  const Eigen::Vector3d p((eyes.x - cameras.cx) / cameras.fx * z,
                          (eyes.y - cameras.cy) / cameras.fy * z, z);
  return mount_.pose_in("head", image.time, frames_) * p;
}

void Faces::send(const hc::Header& image, const std::vector<Track>& seen) {
  auto draft = faces_.loan(static_cast<std::int32_t>(seen.size()), hc::people::kFaceColumns);
  draft.header.time = image.time;
  draft.header.coord = image.coord;
  std::optional<Eigen::Vector3d> nearest;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto& [number, face, time] = seen[i];
    const auto p = place(image, seen[i]);
    if (!nearest || p.norm() < nearest->norm()) nearest = p;
    write(hc::people::FaceRow{face, number, person(number), p}, draft.matrix().row(i));
  }
  faces_.send(std::move(draft));
  if (nearest) target_.send({nearest->x(), nearest->y(), nearest->z()}, image.time);
}

int Faces::person(int track) const {
  const auto embedding = views_.embedding(track);
  if (!embedding) return 0;
  const auto found = folder_->gallery().find(*embedding, static_cast<float>(*same_));
  return found ? found->number : 0;
}

void Faces::take_request(std::string_view text) {
  const auto named = hc::people::numbered_name(text);
  if (!named) throw hc::BadMessage("it is not \"TRACK NAME\"");
  if (!hc::people::is_person_name(named->name))
    throw hc::BadMessage("it has no name of 1 to 64 bytes");
  const NameRequest request{named->number, std::string(named->name),
                            module_.monotonic() + kRequestLife};
  for (const NameRequest& other : requests_)
    if (other.track == request.track && other.name == request.name) return;  // it waits already
  if (requests_.size() == kMostRequests)
    refuse(request, "too many names wait: try again");
  else if (!learn(request))
    requests_.push_back(request);
}

void Faces::answer_requests() {
  std::erase_if(requests_, [this](const NameRequest& request) { return learn(request); });
}

void Faces::refuse(const NameRequest& request, const std::string& why) {
  module_.log(hc::format("{} was not learned: {}", request.name, why), hc::Level::Warning);
}

bool Faces::learn(const NameRequest& request) {
  const auto& [track, name, until] = request;
  if (!views_.embedding(track) && networks_->search.follows(track, last_) &&
      views_.may_become_sure(track) && module_.monotonic() < until)
    return false;
  // A person asked for it, so each answer is logged.
  if (const auto why = reason_against(request)) {
    refuse(request, *why);
    return true;
  }
  const auto& views = views_.views(track);
  if (const auto learned = folder_->learn(name, views); !learned) {
    refuse(request, learned.error().detail);
    return true;
  }
  module_.log(hc::format("learned {} from {} views", name, views.size()));
  read_folder();
  return true;
}

std::optional<std::string> Faces::reason_against(const NameRequest& request) const {
  const auto& [track, name, until] = request;
  if (!networks_->search.follows(track, last_))
    return hc::format("no face has track {} now: try again", track);
  if (!views_.embedding(track))
    return "it is not certain whose face it is: try again, away from other faces";
  for (const auto& [known, number] : folder_->gallery().names())
    if (number == person(track) && known != name)
      return hc::format("it is {} already; rename the file {}/{}", known, *people_, known);
  return std::nullopt;
}
