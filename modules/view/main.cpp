// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "view.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"view",
                    "Shows images in a window and saves them as PNG files.",
                    {.finish_when_stopped = true}};
  ImageView view{module};
  return view.finish(module.run(argc, argv));
}
