// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/codecs.h>

namespace hc::internal {

Result<Message> expand_zstd(const Message&) {
  return no_codec("zstd", "libzstd-dev");
}
Result<Message> compress_zstd(const Message&) {
  return no_codec("zstd", "libzstd-dev");
}

}  // namespace hc::internal
