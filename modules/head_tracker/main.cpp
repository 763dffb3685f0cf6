// SPDX-License-Identifier: Apache-2.0
// The supervisor's head, by any tracker that opentrack supports.
#include <drivers/head_tracker/tracked_head.h>

#include <frames/messages.h>
#include <hc/module/module.h>

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
  std::optional<hc::TrackedHead> head;
  auto pass = [&] { hc::succeed_or_end(head->pass(clock.monotonic(), hc::duration(*silence))); };

  module.on_start([&] {
    head.emplace(
        hc::TrackedHeadOptions{*host, static_cast<int>(*port), *centre_first},
        [&](std::string_view line) { module.log(line); },
        [&](const auto&... problem) { module.log_once(problem...); });
    pass();
  });
  module.every(hc::TrackedHead::kLook, pass);
  module.keep_running();
  module.on(centre, [&](const hc::Message&) { head->centre(); });
  module.on_readable([&] { return head->descriptor(); },
                     [&] {
                       const auto pose = hc::value_or_end(head->receive(clock.monotonic()));
                       if (!pose) return;
                       rotation.send(hc::rotation(pose->pose.angles()).at(pose->time));
                       position.send(hc::position(pose->pose.p).at(pose->time));
                     });
  return module.run(argc, argv);
}
