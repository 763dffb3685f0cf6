// SPDX-License-Identifier: Apache-2.0
// A simulated pan-tilt unit: answers on a pseudo-terminal as a real one does on a serial line,
// moves in real time, and fails on request.
#include <algorithm>
#include <numbers>
#include <optional>

#include <drivers/pan_tilt/unit.h>
#include <hc/module/module.h>

#include "terminal.h"
#include "wire.h"

namespace {

constexpr double kStep =
    hc::pan_tilt::kArcsecondsPerPosition / 3600 * std::numbers::pi / 180;  // [rad/position]

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"fake_pan_tilt", "A simulated pan-tilt unit on a pseudo-terminal."};
  auto motion = module.output("motion", hc::rotation<double>().of(1, 1).in(hc::Coord::kGaze),
                              "truth: 0, tilt, pan [rad]");
  auto device = module.output("device", hc::string(),
                              "device to open; empty while unplugged; each second and on change");
  auto received = module.output("received", hc::string(), "bytes received, in pieces as they came");
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
                                    "the line is disconnected; afterwards there is a new one");
  auto bytes_per_second = module.parameter("bytes_per_second", 0.0, "1/s",
                                           "of the line, each way; 960 is 9600 baud, 0: unbounded",
                                           {.min = 0, .max = 1e9});

  const hc::SystemClock clock;
  const auto start = clock.monotonic();
  auto seconds = [&] { return hc::seconds(clock.monotonic() - start); };
  std::optional<hc::pan_tilt::Unit> unit;
  std::optional<Terminal> terminal;
  std::optional<Wire> to_unit, from_unit;

  auto send_device = [&] {
    device.send(hc::string(terminal ? terminal->path() : "").at(module.now()));
  };
  auto plug = [&] {
    if (*unplugged)
      terminal.reset();
    else
      terminal = hc::value_or_end(Terminal::open());
    to_unit->clear();
    from_unit->clear();
    send_device();
  };
  /// All that is due: bytes reach the unit, and its answers the line.
  hc::Timeout serve = module.after(std::chrono::nanoseconds(0), [&] {
    if (*unplugged == terminal.has_value()) plug();
    const double now = seconds();
    if (terminal) to_unit->put(now, terminal->read(), {0, *bytes_per_second, 0});
    const std::string bytes = to_unit->take(now);
    if (!bytes.empty()) received.send(hc::string(bytes).at(module.now()));
    const std::string answer = unit->take(now, bytes) + unit->pass(now);
    if (!*silent) from_unit->put(now, answer, {*answer_delay, *bytes_per_second, *garbage});
    if (terminal) terminal->write(from_unit->take(now));
    double next = 0.02;  // [s] at the latest, for parameters
    for (auto due : {to_unit->next(), from_unit->next(), unit->next()})
      if (due) next = std::min(next, *due - now);
    serve.restart(hc::duration(next));
  });

  module.on_start([&] {
    unit.emplace(*pan / kStep, -*tilt / kStep);
    to_unit.emplace(static_cast<std::uint64_t>(*seed));
    from_unit.emplace(static_cast<std::uint64_t>(*seed));
    plug();
  });
  module.on_readable([&] { return terminal ? terminal->descriptor() : -1; },
                     [&] { serve.restart(std::chrono::nanoseconds(0)); });
  module.every(rate, [&] {
    const double now = seconds();
    motion.send(
        hc::rotation(0.0, -unit->tilt(now) * kStep, unit->pan(now) * kStep).at(module.now()));
  });
  module.every(std::chrono::seconds(1), send_device);
  return module.run(argc, argv);
}
