// SPDX-License-Identifier: Apache-2.0
// Takes a known time over each message, and sends what it was given a factor larger.
#include <thread>

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"delay", "Multiplies numbers, and takes its time."};
  auto in = module.input("in", hc::table(), "a number");
  auto out = module.output("out", hc::table(), "the number times the factor");
  auto seconds = module.parameter("seconds", 0.0, "s", "taken for each", {.min = 0, .max = 60});
  auto factor = module.parameter("factor", 1.0, "", "of the number");
  module.on(in, [&](const auto& message) {
    std::this_thread::sleep_for(hc::duration(*seconds));
    out.send({*factor * message.matrix().at(0, 0)});
  });
  return module.run(argc, argv);
}
