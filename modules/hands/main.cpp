// SPDX-License-Identifier: Apache-2.0
#include <opencv2/core/utility.hpp>

#include <transports/all.h>
#include <vision/hush.h>

#include "hands.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::vision::hush_opencv();
  cv::setNumThreads(1);  // threads that wait for one another busily would take all cores
  hc::Module module{"hands",
                    "Finds and follows hands in images, their signs, and where they point to.",
                    {.background = true}};
  Hands hands{module};
  return module.run(argc, argv);
}
