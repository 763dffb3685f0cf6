// SPDX-License-Identifier: Apache-2.0
#pragma once
// The device file of a joystick, which one process alone has: a stick moves one robot.

#include <string>

#include <hc/os/descriptor.h>

namespace hc {

struct DeviceFile {
  internal::Descriptor file;  ///< none (-1) where it cannot be opened
  bool is_taken = false;      ///< another process has it

  /// Opens a device file, "/dev/input/event5", for reading without waiting, and locks it (flock)
  /// until it is closed or the process has ended.
  static DeviceFile open(const std::string& path);
};

}  // namespace hc
