// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>
#include <vision/hush.h>

#include "augment.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::vision::hush_opencv();
  hc::Module module{"augment",
                    "Draws objects into the images of both eyes, with "
                    "occlusion.",
                    {.background = true}};
  Augment augment{module};
  return module.run(argc, argv);
}
