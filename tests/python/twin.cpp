// SPDX-License-Identifier: Apache-2.0
// What a module in Python says of itself is compared with this one.
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"camera_like", "Has a bit of everything."};
  auto image = module.input("image", hc::rgb_image(), "an image");
  auto pose = module.input("pose",
                           hc::any_of(hc::transformation(),
                                      hc::rotation().of(1, 1).in(hc::Coord::kGaze)),
                           "where", {.actor = true, .keep = 3});
  module.input("any", hc::anything(), "all");
  auto mean = module.output("mean", hc::table().of(1, 3).in(7), "numbers");
  module.output("sound", hc::sound(2).in(hc::Coord::kSound16k), "noise");
  module.parameter("loud", true, "", "a bool");
  module.parameter("rate", 2.5, "Hz", "a number", {.min = 0, .max = 100});
  module.parameter("count", 8, "", "an integer", {.min = 2, .max = 64, .step = 2});
  module.parameter("name_of_it", "a", "", "a string", {.choices = {"a", "b"}, .positional = true});
  module.parameter("device", "/dev/null", "", "a fixed string", {.fixed = true});
  return module.run(argc, argv);
}
