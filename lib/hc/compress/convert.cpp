// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/convert.h>

#include <hc/compress/compress.h>
#include <hc/compress/scale.h>

namespace hc {

Result<Message> convert(const Message& message, const Conversion& conversion) {
  Message made = message;
  const auto& header = message.header;
  if (conversion.scale != 1 && can_scale(header.info) && !header.empty())
    made = HC_TRY(shrink(message, scaled(header.width, conversion.scale),
                         scaled(header.height, conversion.scale)));
  if (!conversion.as) return made;
  Header wanted = made.header;
  wanted.info.encoding = *conversion.as;
  if (!check(wanted, {~std::uint64_t{0}})) return made;
  return compress(made, *conversion.as, conversion.quality.value_or(kJpegQuality));
}

}  // namespace hc
