// SPDX-License-Identifier: Apache-2.0
#pragma once
// The device file of a joystick, which one process alone has: a stick moves one robot.

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <string>

#include <hc/os/descriptor.h>

namespace hc {

struct DeviceFile {
  Descriptor file;        ///< none (-1) where it cannot be opened
  bool is_taken = false;  ///< another process has it

  /// Opens a device file, "/dev/input/event5", for reading without waiting, and locks it (flock)
  /// until it is closed or the process has ended.
  static DeviceFile open(const std::string& path) {
    DeviceFile made;
    made.file = Descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    made.is_taken =
        made.file && ::flock(made.file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    return made;
  }
};

}  // namespace hc
