// SPDX-License-Identifier: Apache-2.0
#pragma once
// A microphone, with SDL2.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <sound/device.h>
#include <sound/format.h>

namespace hc::audio {

/// A piece of recorded sound.
struct Heard {
  std::vector<std::int16_t> samples;  ///< channels next to one another
  Time time;                          ///< of the last frame
};

/// Records in pieces of one length. For one thread.
class Capture {
 public:
  /// @param device  SDL's name; "": the default.
  /// @param frames  of a piece.
  ///
  /// Errors: System (no such device, no sound system).
  static Result<std::unique_ptr<Capture>> open(const std::string& device, const Format& format,
                                               int frames);
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  ~Capture();

  /// Waits for the next piece; nothing on timeout or if `stop` is readable. The queue holds 2 s;
  /// then the oldest pieces are dropped.
  std::optional<Heard> take(std::chrono::milliseconds timeout, int stop = -1);

  /// For poll(): readable while there are pieces.
  [[nodiscard]] int descriptor() const;
  /// False once the device is disconnected.
  [[nodiscard]] bool is_there() const;
  /// Pieces dropped so far.
  [[nodiscard]] std::int64_t lost() const;

 private:
  struct Queue;
  Capture(AudioSystem system, std::unique_ptr<Queue> queue);

  AudioSystem system_;
  std::unique_ptr<Queue> queue_;  // filled on SDL's thread
  std::uint32_t device_ = 0;
};

}  // namespace hc::audio
