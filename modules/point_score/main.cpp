// SPDX-License-Identifier: Apache-2.0
// Measures the latency from a stick to the motion of the head in a simulation.
#include <optional>

#include <frames/messages.h>
#include <hc/module/module.h>
#include <transports/all.h>

#include "pusher.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"point_score", "Pushes a stick and measures when the head begins to move."};
  auto motion = module.input("motion", hc::rotation().in(hc::Coord::kGaze),
                             "truth: roll, tilt, pan of the head [rad]");
  auto report = module.input("gaze", hc::rotation().in(hc::Coord::kGaze),
                             "measured head orientation; the first starts the test");
  auto stick = module.output("stick", hc::table().of(1, 2), "left > 0, down > 0, -1 to 1");
  auto result = module.output("score", hc::table().of(1, 4),
                              "median and maximum time from the stick to the motion [s], "
                              "pushes that moved the head, pushes");
  auto count = module.parameter("count", 20, "", "pushes", {.min = 1, .max = 1e6, .fixed = true});
  auto seed = module.parameter("seed", 1, "", "of the times, directions and lengths of the pushes",
                               {.min = 0, .max = 1e9, .fixed = true});
  auto rate = module.parameter("rate", 50.0, "Hz", "repetition rate while the stick is deflected",
                               {.min = 1, .max = 1000});
  auto acceleration = module.parameter("acceleration", 1.795, "rad/s²", "of the unit",
                                       {.min = 0.01, .max = 1000, .fixed = true});
  auto base_speed = module.parameter("base_speed", 0.8976, "rad/s",
                                     "speed up to which the unit starts and stops at once",
                                     {.min = 0, .max = 100, .fixed = true});

  std::optional<Pusher> pusher;
  bool is_ready = false;
  module.on_start([&] {
    pusher.emplace(Pusher::Options{.count = static_cast<int>(*count),
                                   .seed = static_cast<std::uint64_t>(*seed),
                                   .unit = {*acceleration, *base_speed}});
  });
  module.on(motion, [&](const auto& message) {
    const auto q = hc::value_or_drop(hc::rotation_of(message));
    pusher->take(hc::seconds(message.header.time.time_since_epoch()), hc::gaze::angles_of(q));
  });
  module.on(report, [&](const auto&) { is_ready = true; });
  module.every(std::chrono::milliseconds(1), [&] {
    if (!is_ready) return;
    const hc::Time now = module.now();
    if (const auto pushed = pusher->look(hc::seconds(now.time_since_epoch()), *rate))
      stick.send({pushed->left, pushed->down}, now);
    if (!pusher->is_done()) return;
    const auto score = pusher->score();
    result.send(score.numbers());
    module.log(score.text(), hc::Level::Result);
    module.stop();
  });
  return module.run(argc, argv);
}
