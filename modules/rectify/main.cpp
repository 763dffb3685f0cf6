// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "rectify.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"rectify", "Turns the images of two cameras into a rectified pair."};
  Rectify rectify{module};
  return module.run(argc, argv);
}
