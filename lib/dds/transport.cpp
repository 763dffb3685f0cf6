// SPDX-License-Identifier: Apache-2.0
#include <dds/transport.h>

#include <dds/ends.h>
#include <dds/place.h>
#include <hc/link/transport.h>

namespace hc::dds {

void add_transport() {
  hc::add_transport({"dds", "domain interface wait reconnect keep rate burst bandwidth memory",
                     "domain interface readers stay wait keep rate burst bandwidth memory timeout",
                     open_source, open_sink, [](const Uri& uri) {
                       auto place = parse_place(uri);
                       return place ? Status() : place.error();
                     }});
}

}  // namespace hc::dds
