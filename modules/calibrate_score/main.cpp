// SPDX-License-Identifier: Apache-2.0
// Compares a head calibration with the parameters of the simulation.
#include <cmath>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"calibrate_score", "Compares a head's calibration with the truth."};
  auto result = module.input("result", hc::table(), "result of calibrate", {.keep = 1});
  auto score = module.output("score", hc::table().of(1, 3),
                             "left and right identified correctly 0/1, error of the zero, of the "
                             "right eye's offset [rad]");
  auto swapped = module.parameter("swapped", false, "", "truth: the cameras are swapped");
  auto zero_pan = module.parameter("zero_pan", 0.0, "rad", "truth");
  auto zero_tilt = module.parameter("zero_tilt", 0.0, "rad", "truth");
  auto offset_roll = module.parameter("offset_roll", 0.0, "rad", "truth");
  auto offset_pitch = module.parameter("offset_pitch", 0.0, "rad", "truth");
  auto offset_yaw = module.parameter("offset_yaw", 0.0, "rad", "truth");
  auto timeout =
      module.parameter("timeout", 60.0, "s", "to wait for a result", {.min = 1, .max = 3600});

  module.on(result, [&](const auto& message) {
    const auto found = message.matrix().numbers();
    if (found.size() < 6) throw hc::BadMessage("the result is not one of calibrate");
    const bool is_right = (found[0] != 0) == *swapped;
    const double zero = std::hypot(found[1] - *zero_pan, found[2] - *zero_tilt);
    const double offset =
        std::hypot(found[3] - *offset_roll, found[4] - *offset_pitch, found[5] - *offset_yaw);
    score.send({is_right ? 1.0 : 0.0, zero, offset});
    module.log(hc::format("left and right {}, zero off by {:.3f}°, camera offset by {:.3f}°",
                          is_right ? "identified correctly" : "MIXED UP", zero * 180 / M_PI,
                          offset * 180 / M_PI),
               hc::Level::Result);
    module.stop();
  });
  constexpr std::chrono::milliseconds kLook{50};
  std::int64_t looks = 0;
  module.every(kLook, [&] {
    if (++looks * kLook > hc::duration(*timeout)) throw hc::ModuleError("no result within timeout");
  });
  return module.run(argc, argv);
}
