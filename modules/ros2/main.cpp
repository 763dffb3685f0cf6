// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "ros2.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"ros2",
                    "Talks to ROS 2: outputs of the graph as topics, and topics here.",
                    {.keep_running = true}};
  Ros2 ros2{module};
  return module.run(argc, argv);
}
