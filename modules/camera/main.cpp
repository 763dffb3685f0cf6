// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>
#include <vision/hush.h>

#include "camera.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::vision::hush_opencv();
  hc::Module module{"camera", "Sends the images of a camera, a video or image files."};
  Camera camera{module};
  return module.run(argc, argv);
}
