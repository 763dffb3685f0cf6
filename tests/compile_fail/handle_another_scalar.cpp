// SPDX-License-Identifier: Apache-2.0
// What a port of 32-bit floats takes is not seen as doubles.
// error: (no viable conversion|cannot convert|could not convert|conversion from)
#include <hc/node/module.h>

#ifdef HC_WRONG
using Seen = double;
#else
using Seen = float;
#endif

int main(int argc, char** argv) {
  hc::Module module{"wrong", "Looks at a depth map."};
  auto depth = module.input("depth", hc::intensity_image<float>(), "a depth map");
  module.on(depth, [](const auto& message) {
    hc::MatrixView<const Seen> metres = message.matrix();
    return metres.height();
  });
  return module.run(argc, argv);
}
