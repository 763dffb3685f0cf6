// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "speak.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"speak", "Speaks text aloud, by eSpeak NG."};
  Speak speak{module};
  const int status = module.run(argc, argv);
  speak.log_result();
  return status;
}
