// SPDX-License-Identifier: Apache-2.0
#include <hc/link/link.h>

namespace hc {

Draft Sink::loan(const Header& header) {
  return Draft::make(header);
}

Status Source::resume() {
  return Error{Code::Unsupported, "only a file can be read on after an error"};
}

Result<bool> receive(Source& source, Message& message, int stop) {
  while (true) {
    auto got = source.take(message);
    if (!got) return got.error();
    if (*got == Got::Message) return true;
    if (*got == Got::End) return false;
    if (auto ready = source.wait(stop); !ready) return ready.error();
  }
}

}  // namespace hc
