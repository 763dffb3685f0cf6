// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/device_file.h>

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>

namespace hc {

DeviceFile DeviceFile::open(const std::string& path) {
  DeviceFile made;
  made.file = internal::Descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  made.is_taken =
      made.file && ::flock(made.file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  return made;
}

}  // namespace hc
