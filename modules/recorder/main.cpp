// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "recorder.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "recorder", "Records streams into an MCAP file or a folder.", {.finish_when_stopped = true}};
  StreamRecorder recorder{module, stream_names(argc, argv)};
  return recorder.finish(module.run(argc, argv));
}
