// SPDX-License-Identifier: Apache-2.0
// The supervisor's head, by any tracker that opentrack supports.
#include <drivers/head_tracker/head_tracker.h>

#include <optional>

#include <frames/messages.h>
#include <hc/base/backoff.h>
#include <hc/base/format.h>
#include <hc/module/module.h>

namespace {

constexpr std::chrono::milliseconds kLook{20};  // how often a port in use is tried again

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"head_tracker", "Follows a person's head by an opentrack tracker."};
  auto centre = module.input("centre", hc::anything(), "makes the head's pose the new zero");
  auto rotation = module.output("rotation", hc::rotation<double>().in(hc::Coord::kSupervisor),
                                "roll, pitch, yaw since the zero [rad]; yaw > 0 turns left, pitch "
                                "> 0 looks down");
  auto position = module.output("position", hc::position<double>().in(hc::Coord::kSupervisor),
                                "x forward, y left, z up since the zero [m]");
  auto host =
      module.parameter("host", "127.0.0.1", "",
                       "address of this machine to listen on, 0.0.0.0: all", {.fixed = true});
  auto port =
      module.parameter("port", 4242, "", "UDP port", {.min = 0, .max = 65535, .fixed = true});
  auto centre_first = module.parameter(
      "centre_first", true, "", "the first pose is the zero; else the tracker's", {.fixed = true});
  auto silence = module.parameter("silence", 1.0, "s", "time without packets until it is logged",
                                  {.min = 0.01, .max = 3600});

  const hc::SystemClock clock;
  std::optional<hc::HeadTracker> tracker;
  hc::Backoff backoff;
  hc::HeadPose zero;
  bool centre_next = false, is_first = true, receives = false;
  std::string where;
  auto silent = module.after(std::chrono::seconds(1), [&] {
    module.log("no packets received on UDP " + where);
    receives = false;
  });
  auto listen = [&] {
    if (tracker || !backoff.is_due(clock.monotonic())) return;
    auto opened = hc::HeadTracker::open(*host, static_cast<int>(*port));
    if (!opened && opened.error().code == hc::Code::Invalid) throw hc::ModuleError(opened.error());
    if (!opened) {
      backoff.fail(clock.monotonic());
      return module.log_once("port in use", opened.error().detail + "; retrying");
    }
    tracker.emplace(std::move(*opened));
    where = *host + ":" + std::to_string(tracker->port());
    module.log("listening on UDP " + where);
    silent.restart(hc::duration(*silence));
  };
  auto receive = [&] {
    const auto invalid = tracker->ignored();
    const auto pose = hc::value_or_end(tracker->receive());
    if (const auto more = static_cast<std::int64_t>(tracker->ignored() - invalid); more > 0)
      module.log_once("invalid packet", "ignored " + tracker->why_ignored(), more);
    if (!pose) return;
    silent.restart(hc::duration(*silence));
    if (!std::exchange(receives, true)) module.log("receiving from the tracker");
    if (is_first && *centre_first) {
      const Eigen::Vector3d angles = pose->pose.angles().array() + 0.0;  // not -0
      module.log(hc::format("zero set to the first pose: roll {:.2f}, pitch {:.2f}, yaw {:.2f} rad",
                            angles.x(), angles.y(), angles.z()));
      centre_next = true;
    }
    if (centre_next) zero = pose->pose;
    centre_next = is_first = false;
    const auto relative = pose->pose.relative_to(zero);
    rotation.send(hc::rotation(relative.angles()).at(pose->time));
    position.send(hc::position(relative.p).at(pose->time));
  };

  module.on_start([&] {
    silent.stop();
    listen();
  });
  module.every(kLook, listen);
  module.keep_running();
  module.on(centre, [&](const hc::Message&) { centre_next = true; });
  module.on_readable([&] { return tracker ? tracker->descriptor() : -1; }, receive);
  return module.run(argc, argv);
}
