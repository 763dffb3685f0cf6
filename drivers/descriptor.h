// SPDX-License-Identifier: Apache-2.0
#pragma once
// File descriptors that close themselves, for drivers and the devices that modules simulate.

#include <hc/os/descriptor.h>

namespace hc {}  // namespace hc
