// SPDX-License-Identifier: Apache-2.0
// Passes on what comes. The smallest module with an input and an output.
#include <hc/module/module.h>

int main(int argc, char** argv) {
  hc::Module module{"relay", "Passes on what comes, as it is."};
  auto in = module.input("in", hc::anything(), "any message");
  auto out = module.output("out", hc::anything(), "the same: src, seq, ttl and all");
  module.on_raw(in, [&](const hc::Message& message) { out.forward(message); });
  return module.run(argc, argv);
}
