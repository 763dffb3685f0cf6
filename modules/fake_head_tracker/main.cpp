// SPDX-License-Identifier: Apache-2.0
// Simulates a person's head tracker: sends opentrack packets, and the ground truth.
#include <optional>
#include <random>
#include <string>
#include <utility>

#include <drivers/head_tracker/sender.h>
#include <frames/messages.h>
#include <hc/module/module.h>
#include <transports/all.h>

#include "nod.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "fake_head_tracker", "Simulated head tracker (opentrack protocol).", {.keep_running = true}};
  auto address = module.input("address", hc::string(),
                              "where the head_tracker of its graph listens; empty: sends nothing",
                              {.keep = 1});
  auto rotation = module.output("rotation", hc::rotation().of(1, 1).in(hc::Coord::kSupervisor),
                                "truth: roll 0, pitch, yaw of the head [rad]");
  auto rate = module.parameter("rate", 100.0, "Hz", "packets a second", {.min = 0, .max = 1000});
  auto amplitude = module.parameter("amplitude", 0.7, "rad", "how far the head turns to each side",
                                    {.min = 0.01, .max = 1.5, .fixed = true});
  auto speed = module.parameter("speed", 1.047, "rad/s", "maximum of the head",
                                {.min = 0.01, .max = 20, .fixed = true});
  auto noise = module.parameter("noise", 0.0, "rad", "standard deviation of the packets' angles",
                                {.min = 0, .max = 1});
  auto seed = module.parameter("seed", 1, "", "of the noise, and of the first side",
                               {.min = 0, .max = 1e9, .fixed = true});

  std::string sends_to;
  std::optional<hc::HeadPoseSender> sender;
  std::optional<hc::MonotonicTime> start;
  std::mt19937_64 random;
  std::normal_distribution<double> error(0, 1);
  double side = 1;

  module.on_start([&] {
    random.seed(static_cast<std::uint64_t>(*seed));
    side = random() % 2 == 0 ? 1 : -1;
  });
  module.on(address, [&](const auto& message) {
    if (std::exchange(sends_to, message.text()) == sends_to) return;
    sender.reset();
    if (sends_to.empty()) return;
    auto opened = hc::HeadPoseSender::open(sends_to);
    if (opened)
      sender.emplace(std::move(*opened));
    else
      module.log_once("no address", opened.error().detail);
  });
  module.every(rate, [&] {
    const auto now = module.monotonic();
    const hc::Time time = module.now();
    if (!start) start = now;
    const auto angles = angles_at({*amplitude, *speed}, hc::seconds(now - *start));
    const double pitch = side * angles.pitch, yaw = side * angles.yaw;
    const double noisy_yaw = yaw + *noise * error(random);
    const double noisy_pitch = pitch + *noise * error(random);
    hc::HeadPose pose;
    pose.R = hc::frames::rotation(0, noisy_pitch, noisy_yaw).toRotationMatrix();
    if (auto packet = sender ? sender->send(pose) : hc::Status(); !packet)
      module.log_once("packet not sent", "packet not sent: " + packet.error().detail);
    rotation.send({0.0, pitch, yaw}, time);
  });
  return module.run(argc, argv);
}
