// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "augment_score.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"augment_score",
                    "Compares where augment draws a cube with where a real one would be seen."};
  AugmentScore score{module};
  return module.run(argc, argv);
}
