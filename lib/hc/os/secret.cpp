// SPDX-License-Identifier: Apache-2.0
#include <hc/os/secret.h>

#include <sys/random.h>

#include <array>
#include <cstdlib>
#include <iterator>

#include <hc/base/check.h>
#include <hc/base/format.h>

namespace hc {

std::string make_secret() {
  std::array<unsigned char, 16> bytes;
  HC_CHECK(::getrandom(bytes.data(), bytes.size(), 0) == std::ssize(bytes));
  return hexadecimal(bytes);
}

std::string run_secret() {
  const char* given = std::getenv(kRunSecret);
  return given == nullptr || *given == '\0' ? make_secret() : given;
}

}  // namespace hc
