// SPDX-License-Identifier: Apache-2.0
// Scores how soon a palm that is held up stops a robot, and stops without one, against the ground
// truth of a simulation.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <hc/module/module.h>
#include <room/truth_rows.h>
#include <transports/all.h>

#include "score.h"

namespace {

constexpr std::uint8_t kClearAll = 2;  // for the workspace

double seconds_of(hc::Time time) {
  return hc::seconds(time.time_since_epoch());
}

class Program {
 public:
  explicit Program(hc::Module& module) : module_(module) {
    module.on_start([this] { silence_.restart(hc::duration(*timeout_)); });
    module.on(joints_, [this](const auto& message) { see(message); });
    module.on(stopped_, [this](const auto& message) {
      if (message.numbers()[0] == 0) return score_.go();
      score_.stop(seconds_of(message.header.time));
    });
  }

 private:
  void see(const hc::MessageOf<hc::TableKind<double>>& message) {
    silence_.restart(hc::duration(*timeout_));
    const double time = seconds_of(message.header.time);
    score_.see(time, hands_of(message.matrix()));
    if (score_.wants_to_go(time)) clear_.send({kClearAll}, module_.now());
    if (score_.duration() < *duration_) return;
    result_.send(score_.numbers());
    module_.log(score_.text(), hc::Level::Result);
    module_.stop();
  }

  [[nodiscard]] std::vector<ShownHand> hands_of(const hc::MatrixView<const double>& rows) const {
    std::vector<ShownHand> shown;
    for (const auto& hand : hc::room::true_hands(rows)) {
      // Behind the eye a joint has the pixel (0, 0).
      const bool is_in_image = std::ranges::all_of(hand.pixels, [this](const Eigen::Vector2d& at) {
        return at.x() > 0 && at.x() < static_cast<double>(*width_) && at.y() > 0 &&
               at.y() < static_cast<double>(*height_);
      });
      shown.push_back({hand, is_in_image});
    }
    return shown;
  }

  hc::Module& module_;
  hc::Input<hc::TableKind<double>> joints_ =
      module_.input("hand_joints", hc::table().of(0, hc::room::kJointColumns),
                    "truth: of the simulator", {.keep = 64});
  hc::Input<hc::TableKind<std::uint8_t>> stopped_ = module_.input(
      "stopped", hc::table<std::uint8_t>().of(1, 1), "stopped of workspace", {.keep = 64});
  hc::Output<hc::TableKind<std::uint8_t>> clear_ = module_.output(
      "clear", hc::table<std::uint8_t>().of(1, 1),
      "for workspace: 2 some time after a stop, when no palm is up, so that the next "
      "one can stop it");
  hc::Output<hc::TableKind<double>> result_ = module_.output(
      "score", hc::table().of(1, 7), "at the end",
      {.columns = {"median [s]", "maximum [s]", "palms that stopped it", "palms",
                   "stops without a palm", "stops by one at the border", "duration [s]"}});
  hc::Parameter<double> duration_ =
      module_.parameter("duration", 60.0, "s", "how long it is scored", {.min = 0.1, .max = 1e6});
  hc::Parameter<std::int64_t> width_ =
      module_.parameter("width", 800, "px", "of the images: a palm counts that is in the image",
                        {.min = 16, .max = 8192});
  hc::Parameter<std::int64_t> height_ =
      module_.parameter("height", 600, "px", "of the images", {.min = 16, .max = 8192});
  hc::Parameter<double> timeout_ =
      module_.parameter("timeout", 60.0, "s", "to wait for an image", {.min = 1, .max = 3600});

  StopScore score_;
  hc::Timeout silence_ = module_.after(std::chrono::seconds(60),
                                       [] { throw hc::ModuleError("no image within timeout"); });
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"stop_score",
                    "Compares the robot's stops with the palms that are held up in a simulated "
                    "room."};
  Program program{module};
  return module.run(argc, argv);
}
