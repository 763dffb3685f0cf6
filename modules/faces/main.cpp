// SPDX-License-Identifier: Apache-2.0
#include <opencv2/core/utility.hpp>

#include <transports/all.h>
#include <vision/hush.h>

#include "faces.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::vision::hush_opencv();
  cv::setNumThreads(1);  // threads that wait for one another busily would take all cores
  hc::Module module{"faces",
                    "Finds faces in images, follows them, and knows whose they are.",
                    {.background = true}};
  Faces faces{module};
  return module.run(argc, argv);
}
