// SPDX-License-Identifier: Apache-2.0
// A module written outside of the tree: doubles a table's first number.
#include <hc/node/module.h>

int main(int argc, char** argv) {
  hc::Module module{"double", "Doubles a number."};
  auto in = module.input("in", hc::table<double>(), "a number");
  auto out = module.output("out", hc::table<double>(), "twice the number");
  module.on(in, [&](const auto& message) {
    out.send(hc::table({2 * hc::value_or_end(message.template view<double>()).numbers()[0]}));
  });
  return module.run(argc, argv);
}
