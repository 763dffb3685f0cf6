// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>
#include <opencv2/core/utils/logger.hpp>

#include "camera.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // we log errors ourselves
  hc::Module module{"camera", "Sends the images of a camera, a video or image files."};
  Camera camera{module};
  return module.run(argc, argv);
}
