// SPDX-License-Identifier: Apache-2.0
// hc key: the key of one end of tls: links.
#include <tls/key.h>

#include "common.h"
#include "verbs.h"

namespace tool {

void add_key(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  auto* verb = app.add_subcommand(
      "key", "Make a key for tls: links, unless it exists; print its fingerprint");
  verb->add_option("file", *path, "the key and its certificate, readable only by its owner")
      ->required();
  verb->callback([path] {
    if (auto made = hc::tls::make_key(*path); !made) throw Failure(made.error());
    print(value_or_fail(hc::tls::fingerprint_of(*path), *path) + "\n");
  });
}

}  // namespace tool
