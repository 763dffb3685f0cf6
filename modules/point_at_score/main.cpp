// SPDX-License-Identifier: Apache-2.0
// Scores hands, and the places at which they point, against the ground truth of a simulation.
#include <deque>
#include <optional>
#include <utility>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <people/hand_table.h>
#include <room/truth_rows.h>
#include <transports/all.h>

#include "score.h"

namespace {

using Rows = hc::MatrixView<const double>;

class PointAtScore {
 public:
  explicit PointAtScore(hc::Module& module) : module_(module) {
    module.on_start([this] { silence_.restart(hc::duration(*timeout_)); });
    module.on(hc::together(pose_, joints_),
              [this](const auto& pose, const auto& joints) { see(pose, joints.matrix()); });
    module.on(pointed_, [this](const auto& message) {
      const auto row =
          hc::read_row<hc::room::PointedColumns, hc::room::PointedRow>(message.numbers());
      if (!row) return;
      pointed_at_ = {message.header.time, row->p_world};
      for (auto& [time, image] : recent_)
        if (time == message.header.time) image.scene.pointed = pointed_at_->second;
    });
    module.on(hands_, [this](const auto& message) { take_hands(message); });
    module.on(target_, [this](const auto& message) { take_place(message); });
  }

 private:
  using Table = hc::MessageOf<hc::TableKind<double>>;
  struct Image {
    TrueScene scene;
    Eigen::Isometry3d T_world_head;
  };

  void see(const hc::Message& pose, const Rows& joints) {
    silence_.restart(hc::duration(*timeout_));
    const auto time = pose.header.time;
    const auto T_world_head = hc::value_or_drop(hc::pose_of(pose)).T_to_from;
    Image image{{hc::room::true_hands(joints), std::nullopt}, T_world_head};
    if (pointed_at_ && pointed_at_->first == time) image.scene.pointed = pointed_at_->second;
    recent_.emplace_back(time, std::move(image));
    constexpr std::size_t kRecent = 64;
    if (recent_.size() > kRecent) recent_.pop_front();
    if (!begin_) begin_ = time;
    if (time - *begin_ < hc::duration(*duration_)) return;
    result_.send(score_.numbers());
    module_.log(score_.text(), hc::Level::Result);
    module_.stop();
  }

  [[nodiscard]] const Image* at(hc::Time time) const {
    for (const auto& [when, image] : recent_)
      if (when == time) return &image;
    return nullptr;
  }

  void take_hands(const Table& message) {
    const auto* image = at(message.header.time);
    const auto rows = message.matrix();
    for (std::size_t i = 0; image != nullptr && i < rows.height(); ++i) {
      std::array<Eigen::Vector2d, kJoints> found;
      const auto hand = hc::people::hand_in(rows.row(i));
      if (!hand) continue;
      for (std::size_t k = 0; k < kJoints; ++k) found[k] = {hand->points[k].x, hand->points[k].y};
      score_.add_hand(image->scene, found);
    }
  }

  void take_place(const hc::MessageOf<hc::PositionKind<double>>& message) {
    const auto* image = at(message.header.time);
    if (image == nullptr) return;
    const auto p = message.numbers();
    score_.add_place(image->scene, image->T_world_head * Eigen::Vector3d(p[0], p[1], p[2]));
  }

  hc::Module& module_;
  hc::Input<hc::TransformationKind<double>> pose_ = module_.input(
      "head_pose",
      hc::transformation().in(hc::transform_coord(hc::Coord::kWorld, hc::Coord::kHead)),
      "truth: T_world_head", {.keep = 64});
  hc::Input<hc::TableKind<double>> joints_ =
      module_.input("hand_joints", hc::table().of(0, hc::room::kJointColumns),
                    "truth: of the simulator", {.keep = 64});
  hc::Input<hc::TableKind<double>> pointed_ =
      module_.input("pointed", hc::table().of(1, hc::room::kPointedColumns),
                    "truth: of the simulator", {.keep = 64});
  hc::Input<hc::TableKind<double>> hands_ = module_.input(
      "hands", hc::table().of(0, hc::people::kHandColumns), "hands of module hands", {.keep = 64});
  hc::Input<hc::PositionKind<double>> target_ =
      module_.input("target", hc::position().of(1, 1).in(hc::Coord::kHead),
                    "target of module hands", {.keep = 64});
  hc::Output<hc::TableKind<double>> result_ =
      module_.output("score", hc::table().of(1, 4), "at the end",
                     {.columns = {"angle [rad]", "joints [px]", "places", "hands"}});
  hc::Parameter<double> duration_ =
      module_.parameter("duration", 30.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  hc::Parameter<double> timeout_ =
      module_.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});

  Score score_;
  std::deque<std::pair<hc::Time, Image>> recent_;
  std::optional<std::pair<hc::Time, Eigen::Vector3d>> pointed_at_;
  std::optional<hc::Time> begin_;
  hc::Timeout silence_ = module_.after(std::chrono::seconds(60),
                                       [] { throw hc::ModuleError("no image within timeout"); });
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"point_at_score",
                    "Compares hands, and the places at which they point, with those in a simulated "
                    "room."};
  PointAtScore score{module};
  return module.run(argc, argv);
}
