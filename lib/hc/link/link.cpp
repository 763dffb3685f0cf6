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
    const Got got = HC_TRY(source.take(message));
    if (got != Got::Nothing) return got == Got::Message;
    HC_TRY(source.wait(stop));
  }
}

}  // namespace hc
