// SPDX-License-Identifier: Apache-2.0
// A simulated pan-tilt unit on a pseudo-terminal: speaks the protocol of a real one, moves in real
// time, and fails on request.
#include <sched.h>

#include <optional>

#include <hc/module/module.h>
#include <transports/all.h>

#include "simulated_line.h"

namespace {

/// Takes the bytes on the line when they come, as a unit does, and not when other programs let it.
/// Without the right to that (CAP_SYS_NICE, as root has), it is as late as they are.
void run_before_programs() {
  const sched_param least{.sched_priority = 1};
  static_cast<void>(::sched_setscheduler(0, SCHED_RR, &least));
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"fake_pan_tilt", "A simulated pan-tilt unit on a pseudo-terminal."};
  auto motion = module.output("motion", hc::rotation().of(1, 1).in(hc::Coord::kGaze),
                              "truth: 0, tilt, pan [rad]");
  auto device = module.output("device", hc::string(),
                              "device to open; empty while unplugged; each second and on change");
  auto received = module.output("received", hc::string(), "bytes received");
  auto pan = module.parameter("pan", 0.0, "rad", "initial position",
                              {.min = -3.2, .max = 3.2, .fixed = true});
  auto tilt = module.parameter("tilt", 0.0, "rad", "initial position",
                               {.min = -3.2, .max = 3.2, .fixed = true});
  auto seed =
      module.parameter("seed", 1, "", "of corrupted bytes", {.min = 0, .max = 1e9, .fixed = true});
  auto rate = module.parameter("rate", 200.0, "Hz", "of motion", {.min = 0, .max = 10000});
  auto answer_delay =
      module.parameter("answer_delay", 0.0, "s", "of each answer", {.min = 0, .max = 60});
  auto silent = module.parameter("silent", false, "", "obeys, but does not answer");
  auto garbage = module.parameter("garbage", 0.0, "", "share of its bytes that are corrupted",
                                  {.min = 0, .max = 1});
  auto unplugged = module.parameter("unplugged", false, "",
                                    "disconnects the line; plugging in creates a new one");
  auto bytes_per_second = module.parameter("bytes_per_second", 0.0, "1/s",
                                           "of the line, each way; 960 is 9600 baud, 0: unbounded",
                                           {.min = 0, .max = 1e9});

  auto seconds = [] { return hc::seconds(hc::SystemClock().monotonic()); };
  std::optional<SimulatedLine> line;

  auto send_device = [&] { device.send(line->path(), module.now()); };
  hc::Timeout serve = module.after(std::chrono::nanoseconds(0), [&] {
    if (hc::value_or_end(line->plug(!*unplugged))) send_device();
    const double now = seconds();
    const auto bytes = line->serve(now, {*answer_delay, *bytes_per_second, *garbage}, *silent);
    if (!bytes.empty()) received.send(bytes, module.now());
    serve.restart(hc::duration(line->pause(now)));
  });

  module.on_start([&] {
    run_before_programs();
    line.emplace(*pan, *tilt, static_cast<std::uint64_t>(*seed));
    hc::value_or_end(line->plug(!*unplugged));
    send_device();
  });
  module.on_readable([&] { return line->descriptor(); },
                     [&] { serve.restart(std::chrono::nanoseconds(0)); });
  module.every(rate, [&] {
    const double now = seconds();
    motion.send({0.0, line->tilt(now), line->pan(now)}, module.now());
  });
  module.every(std::chrono::seconds(1), send_device);
  return module.run(argc, argv);
}
