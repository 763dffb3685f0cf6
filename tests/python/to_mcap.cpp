// SPDX-License-Identifier: Apache-2.0
// to_mcap FILE: makes a recording in MCAP of the messages on standard input.
#include <hc/link/link.h>
#include <record/writer.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  auto source = hc::open_source(*hc::parse_uri("-"));
  auto sink = hc::record::open_sink(*hc::record::place_of(argv[1]), {});
  if (!source || !sink) return 1;
  hc::Message message;
  for (auto got = hc::receive(**source, message); got && *got; got = hc::receive(**source, message))
    if (!(*sink)->send(message)) return 1;
  return (*sink)->close() ? 0 : 1;
}
