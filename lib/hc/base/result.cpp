// SPDX-License-Identifier: Apache-2.0
#include <hc/base/result.h>

namespace hc {

std::string_view name(Code code) {
  switch (code) {
    case Code::Malformed:
      return "Malformed";
    case Code::Unsupported:
      return "Unsupported";
    case Code::TooLarge:
      return "TooLarge";
    case Code::Truncated:
      return "Truncated";
    case Code::Closed:
      return "Closed";
    case Code::Stopped:
      return "Stopped";
    case Code::NotFound:
      return "NotFound";
    case Code::Invalid:
      return "Invalid";
    case Code::System:
      return "System";
  }
  HC_CHECK(false, static_cast<int>(code));
  return {};
}

std::string Error::text() const {
  return std::string(name(code)) + ": " + detail;
}

}  // namespace hc
