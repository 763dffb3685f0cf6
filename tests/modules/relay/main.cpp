// SPDX-License-Identifier: Apache-2.0
// Forwards messages. The smallest module with an input and an output.
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"relay", "Forwards messages unchanged."};
  auto in = module.input("in", hc::anything(), "any message");
  auto out = module.output("out", hc::anything(), "the same: src, seq, ttl and all");
  module.on_raw(in, [&](const hc::Message& message) { out.forward(message); });
  return module.run(argc, argv);
}
