// SPDX-License-Identifier: Apache-2.0
#pragma once
// Whose memory a message's elements are in. Pure.

#include <hc/mtp/message.h>

namespace hc {

/// Whether a publisher of shm lends the elements: a reader that holds 63 gets further ones as
/// copies, and a publisher without room waits for those.
bool is_lent(const Message& message);

}  // namespace hc
