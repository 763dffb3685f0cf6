// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/serial.h>

#include <fcntl.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hc::pan_tilt {
namespace {

Error failure(std::string_view call) {
  const int number = errno;
  const Code code = number == ENOENT                                       ? Code::NotFound
                    : number == EIO || number == ENXIO || number == ENODEV ? Code::Closed
                    : number == ENOTTY                                     ? Code::Unsupported
                                                                           : Code::System;
  if (code == Code::Closed) return {code, "disconnected"};
  if (code == Code::Unsupported) return {code, "not a serial line"};
  return {code, std::string(call) + ": " + std::strerror(number)};
}

/// Sets low latency if supported; otherwise some adapters collect bytes for 16 ms.
void hurry(int number) {
  serial_struct settings = {};
  if (ioctl(number, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= ASYNC_LOW_LATENCY;
  static_cast<void>(ioctl(number, TIOCSSERIAL, &settings));
}

}  // namespace

Result<Serial> Serial::open(const std::string& device, int baud) {
  termios settings = {};
  // cfsetspeed() takes a rate, but would also accept its code, which is not a rate.
  const auto rate = static_cast<speed_t>(baud);
  if ((rate & ~speed_t{CBAUD}) == 0 || cfsetspeed(&settings, rate) != 0)
    return Error{Code::Unsupported, "no such baud rate: " + std::to_string(baud)};
  int number = -1;
  do {
    number = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  } while (number < 0 && errno == EINTR);
  if (number < 0) return failure("open");
  Serial serial{Descriptor(number)};
  if (tcgetattr(number, &settings) != 0) return failure("tcgetattr");
  // Two programs on one unit would read each other's answers. The lock ends with the process.
  if (flock(number, LOCK_EX | LOCK_NB) != 0)
    return Error{Code::System, "in use by another program"};
  cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cc[VMIN] = 1;  // read() fails with EAGAIN if there is no byte; 0 means disconnected
  settings.c_cc[VTIME] = 0;
  if (cfsetspeed(&settings, rate) != 0 || tcsetattr(number, TCSANOW, &settings) != 0)
    return failure("tcsetattr");
  if (tcflush(number, TCIOFLUSH) != 0) return failure("tcflush");
  hurry(number);
  return serial;
}

Result<std::string_view> Serial::read(std::span<char> room) {
  const ssize_t got = ::read(tty_.get(), room.data(), room.size());
  if (got > 0) return std::string_view(room.data(), static_cast<std::size_t>(got));
  if (got == 0) return Error{Code::Closed, "disconnected"};
  if (errno == EAGAIN || errno == EINTR) return std::string_view();
  return failure("read");
}

Status Serial::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(tty_.get(), bytes.data(), bytes.size());
    if (put > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(put));
      continue;
    }
    if (put < 0 && errno == EINTR) continue;
    if (put < 0 && errno != EAGAIN) return failure("write");
    return Error{Code::System, "output buffer is full"};
  }
  return {};
}

}  // namespace hc::pan_tilt
