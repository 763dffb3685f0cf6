// SPDX-License-Identifier: Apache-2.0
// Chooses the person to look at: the held one, the speaker, or the nearest.
#include <cmath>
#include <optional>
#include <vector>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <people/attention.h>
#include <people/face_table.h>
#include <transports/all.h>

namespace {

using hc::people::Attention;

bool is_track(double number) {
  constexpr double kMost = 1e9;
  return number >= 0 && number <= kMost;
}

class Attend {
 public:
  explicit Attend(hc::Module& module) : module_(module) {
    module.on(faces_, [this](const auto& message) { see(message); });
    module.on(direction_, [this](const auto& message) { hear(message); });
    module.on(hold_, [this](const auto& message) { hold(message.numbers()[0]); });
    module.on_end([this] { frames_.answer_all(); });
  }

 private:
  using Table = hc::MessageOf<hc::TableKind<double>>;

  static double pan_of(const Eigen::Vector3d& p) { return std::atan2(p.y(), p.x()); }

  void see(const Table& message) {
    const auto time = module_.time_of(message.header);
    frames_.when_known("robot", "head", time, [this, time, faces = message](const auto&) {
      attention_.set_options({.hold = hc::duration(*keep_)});
      const auto T_robot_head = frames_.nearest("robot", "head", time);
      const auto rows = faces.matrix();
      std::vector<hc::people::FaceRow> seen;
      for (std::size_t i = 0; i < rows.height(); ++i)
        if (const auto face = hc::people::face_in(rows.row(i));
            face && hc::people::can_be_face(face->place))
          seen.push_back(*face);
      for (const auto& [face, track, person, p] : seen)
        attention_.see(track, time, {pan_of(T_robot_head.linear() * p), p.norm()});
      const auto choice = attention_.choose(time);
      if (choice != last_) tell(time, last_ = choice);
      for (const auto& [face, track, person, p] : seen) {
        if (!choice || track != choice->track) continue;
        target_.send({p.x(), p.y(), p.z()}, time, hc::Coord::kHead);
        attended_.send({double(track), double(person), double(choice->reason)}, time);
      }
    });
  }

  void hear(const hc::MessageOf<hc::RotationKind<double>>& message) {
    const double pan = message.numbers()[2];
    const auto time = module_.time_of(message.header);
    frames_.when_known("robot", "head", time, [this, time, pan](const auto&) {
      const auto T_robot_head = frames_.nearest("robot", "head", time);
      const Eigen::Vector3d to(std::cos(pan), std::sin(pan), 0);
      attention_.hear(time, pan_of(T_robot_head.linear() * to));
    });
  }

  void hold(double track) {
    if (!is_track(track)) throw hc::BadMessage("not the number of a track");
    if (track == 0) return attention_.release();
    attention_.hold(static_cast<int>(track));
    silence_.restart();
  }

  void tell(hc::Time time, const std::optional<Attention::Choice>& choice) {
    if (choice)
      reason_.send(hc::format("looks at track {}, {}", choice->track, text(choice->reason)), time);
    else
      reason_.send("sees no person", time);
  }

  hc::Module& module_;
  hc::Input<hc::TableKind<double>> faces_ = module_.input(
      "faces", hc::table().of(0, hc::people::kFaceColumns).finite(), "faces of module faces");
  hc::Input<hc::RotationKind<double>> direction_ =
      module_.input("direction", hc::rotation().of(1, 1).in(hc::Coord::kHead).finite(),
                    "direction of a sound, from hearing", {.keep = 64});
  hc::Input<hc::TableKind<double>> hold_ =
      module_.input("hold", hc::table().of(1, 1).finite(),
                    "track to hold on to, repeated; 0, or silence for a second: none");
  hc::Output<hc::PositionKind<double>> target_ =
      module_.output("target", hc::position().in(hc::Coord::kHead),
                     "the person looked at: the middle between the eyes");
  hc::Output<hc::TableKind<double>> attended_ =
      module_.output("attended", hc::table().of(1, 3), "the person looked at",
                     {.columns = {"track", "person", "reason: 0 nearest, 1 speaks, 2 held"}});
  hc::Output<hc::StringKind> reason_ =
      module_.output("reason", hc::string(), "at whom it looks, and why, at each change");
  hc::Parameter<double> keep_ =
      module_.parameter("keep", 2.0, "s", "how long a person is looked at before a nearer one",
                        {.min = 0, .max = 60});
  hc::ModuleFrames frames_{module_};

  Attention attention_{{}};
  hc::Timeout silence_ = module_.after(std::chrono::seconds(1), [this] { attention_.release(); });
  std::optional<Attention::Choice> last_;
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"attend", "Chooses the person at whom the head looks."};
  Attend attend{module};
  return module.run(argc, argv);
}
