// SPDX-License-Identifier: Apache-2.0
// A person who turns the head and wears a tracker, without either: packets as opentrack sends them,
// and how the head really is.
#include <algorithm>
#include <optional>
#include <random>

#include <drivers/head_tracker/sender.h>
#include <hc/base/clock.h>
#include <hc/module/module.h>

#include "nod.h"

int main(int argc, char** argv) {
  constexpr std::int32_t kSupervisor = 14;
  hc::Module module{"fake_head_tracker", "A simulated head, told as opentrack tells of one."};
  auto rotation = module.output("rotation", hc::rotation<double>().in(kSupervisor),
                                "truth: roll 0, pitch, yaw of the head [rad]");
  auto port = module.parameter("port", 4242, "", "UDP port of this machine that packets go to",
                               {.min = 1, .max = 65535, .fixed = true});
  auto rate = module.parameter("rate", 100.0, "Hz", "packets a second", {.min = 0, .max = 1000});
  auto amplitude = module.parameter("amplitude", 0.7, "rad", "how far the head turns to each side",
                                    {.min = 0.01, .max = 1.5, .fixed = true});
  auto speed = module.parameter("speed", 1.047, "rad/s", "of the head, at most",
                                {.min = 0.01, .max = 20, .fixed = true});
  auto noise = module.parameter("noise", 0.0, "rad", "standard deviation of what the packets tell",
                                {.min = 0, .max = 1});
  auto seed = module.parameter("seed", 1, "", "of the noise, and of the side it turns to first",
                               {.min = 0, .max = 1e9, .fixed = true});

  const hc::SystemClock clock;
  std::optional<hc::HeadPoseSender> sender;
  std::optional<hc::MonotonicTime> start;
  std::mt19937_64 random;
  double side = 1;
  bool is_well = true;

  module.on_start([&] {
    sender.emplace(hc::value_or_end(hc::HeadPoseSender::open(static_cast<int>(*port))));
    random.seed(static_cast<std::uint64_t>(*seed));
    side = random() % 2 == 0 ? 1 : -1;
  });
  module.every(rate, [&] {
    if (!start) start = clock.monotonic();
    const double seconds = std::chrono::duration<double>(clock.monotonic() - *start).count();
    const std::int64_t time = module.now();
    const auto angles = angles_at({*amplitude, *speed}, seconds);
    const double pitch = side * angles.pitch, yaw = side * angles.yaw;

    std::normal_distribution<double> error(0, 1);
    const double told_yaw = yaw + *noise * error(random);
    const double told_pitch = pitch + *noise * error(random);
    hc::HeadPose pose;
    pose.R = (Eigen::AngleAxisd(told_yaw, Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(told_pitch, Eigen::Vector3d::UnitY()))
                 .toRotationMatrix();
    const auto sent = sender->send(pose);
    if (sent.has_value() != is_well)
      module.log(sent ? "sends packets again" : "sends no packets: " + sent.error().text());
    is_well = sent.has_value();

    auto truth = rotation.loan(1, 1);
    truth.header.time = time;
    const double row[] = {0, pitch, yaw};
    std::copy(std::begin(row), std::end(row), truth.matrix().numbers().begin());
    rotation.send(std::move(truth));
  });
  return module.run(argc, argv);
}
