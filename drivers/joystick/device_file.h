// SPDX-License-Identifier: Apache-2.0
#pragma once
// The device file of a joystick, locked by one process, since a stick moves one robot.

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <string>

#include <hc/os/descriptor.h>

namespace hc {

struct DeviceFile {
  Descriptor file;        ///< -1 if it cannot be opened
  bool is_taken = false;  ///< locked by another process

  /// Opens a device file, "/dev/input/event5", for non-blocking reading, and locks it (flock) until
  /// it is closed or the process ends.
  static DeviceFile open(const std::string& path) {
    DeviceFile made;
    made.file = Descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    made.is_taken =
        made.file && ::flock(made.file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    return made;
  }
};

}  // namespace hc
