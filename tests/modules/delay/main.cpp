// SPDX-License-Identifier: Apache-2.0
// Takes a known time for each message, and sends its number a factor larger.
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
  auto most = module.parameter("most", 1e6, "", "of the number; one above it is dropped");
  module.on(in, [&](const auto& message) {
    std::this_thread::sleep_for(hc::duration(*seconds));
    const double number = message.matrix().at(0, 0);
    if (number > *most) throw hc::BadMessage("it is too large");
    out.send(*factor * number);
  });
  return module.run(argc, argv);
}
