// SPDX-License-Identifier: Apache-2.0
// Reads the pose of the supervisor's head from any tracker that opentrack supports.
#include <string>
#include <vector>

#include <drivers/head_tracker/tracked_head.h>

#include <frames/messages.h>
#include <hc/base/uri.h>
#include <hc/base/words.h>
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"head_tracker", "Follows a person's head by an opentrack tracker.", {.keep_running = true}};
  auto centre = module.input("centre", hc::anything(), "makes the head's pose the new zero");
  auto rotation = module.output("rotation", hc::rotation().in(hc::Coord::kSupervisor),
                                "roll, pitch, yaw since the zero [rad]; yaw > 0 turns left, pitch "
                                "> 0 looks down");
  auto position = module.output("position", hc::position().in(hc::Coord::kSupervisor),
                                "x forward, y left, z up since the zero [m]");
  auto address = module.output("address", hc::string(),
                               "listening address, 127.0.0.1:4242; each second and on change");
  auto listen = module.parameter("listen", "", "",
                                 "[ADDRESS:]PORT of this machine to listen on by UDP, opentrack's "
                                 "is 4242, 0: a free one; empty: none",
                                 {.positional = true, .fixed = true});
  auto sender = module.parameter("sender", "", "",
                                 "addresses of other machines that may send, separated by spaces",
                                 {.fixed = true});
  auto centre_first = module.parameter(
      "centre_first", true, "", "the first pose is the zero; else the tracker's", {.fixed = true});
  auto silence = module.parameter(
      "silence", 1.0, "s", "time without packets until it is logged, and another sender accepted",
      {.min = 0.01, .max = 3600, .fixed = true});

  const hc::SystemClock clock;
  std::optional<hc::TrackedHead> head;
  auto send_address = [&] { address.send(head->address(), module.now()); };
  auto pass = [&] {
    const bool listened = !head->address().empty();
    hc::succeed_or_end(head->pass(clock.monotonic()));
    if (!listened && !head->address().empty()) send_address();
  };

  module.on_start([&] {
    const auto senders = hc::words_of(*sender);
    hc::HostPort place;
    if (listen->empty())
      module.log("idle: `listen` names no port; opentrack's is 4242");
    else
      place = hc::value_or_end(hc::parse_host_port(*listen));
    if (!listen->empty() && place.host.empty()) place.host = "127.0.0.1";
    head.emplace(
        hc::TrackedHeadOptions{place.host,
                               place.port,
                               {senders.begin(), senders.end()},
                               hc::duration(*silence),
                               *centre_first},
        [&](hc::Level level, std::string_view line) { module.log(line, level); },
        [&](const auto&... problem) { module.log_once(problem...); });
    pass();
  });
  module.every(std::chrono::seconds(1), send_address);
  module.every(hc::TrackedHead::kLook, pass);
  module.on(centre, [&](const hc::Message&) { head->centre(); });
  module.on_readable([&] { return head->descriptor(); },
                     [&] {
                       const auto pose = hc::value_or_end(head->receive(clock.monotonic()));
                       if (!pose) return;
                       const auto& p = pose->pose.p;
                       const auto angles = pose->pose.angles();
                       rotation.send({angles.x(), angles.y(), angles.z()}, pose->time);
                       position.send({p.x(), p.y(), p.z()}, pose->time);
                     });
  return module.run(argc, argv);
}
