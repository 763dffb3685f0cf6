// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a link does to messages before it sends them. Stateless, any thread.

#include <hc/base/result.h>
#include <hc/contract/conversion.h>
#include <hc/mtp/message.h>

namespace hc {

/// The message in the form that a link asks for; one that cannot be converted is left as it is.
///
/// Errors: as shrink() and compress(). Cost: none if there is nothing to do.
Result<Message> convert(const Message& message, const Conversion& conversion);

}  // namespace hc
