// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  return run_actor(argc, argv, hc::SystemClock());
}
