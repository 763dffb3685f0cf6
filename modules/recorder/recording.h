// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the module records into: mcap_recording.h, folder_recording.h.

#include <cstddef>
#include <cstdint>
#include <string>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

/// Takes messages of streams, which are numbered in the order of their names, until it fails.
class Recording {
 public:
  virtual ~Recording() = default;

  /// A message that this recording has no place for is lost, which is logged once.
  /// Errors: System (the disk); each later call gives the same.
  virtual hc::Status record(std::size_t stream, const hc::Message& message) = 0;
  /// To be called now and then, and when descriptor() is readable. Errors: as record().
  virtual hc::Status poll() { return {}; }
  /// Below 0: none now.
  [[nodiscard]] virtual int descriptor() const { return -1; }
  /// Writes the last seconds to a file, if this recording keeps them in memory; else does nothing.
  virtual void save() {}
  /// Writes what is left. Errors: System; also what went wrong before.
  virtual hc::Status close() = 0;

  /// The file or the folder.
  [[nodiscard]] virtual const std::string& place() const = 0;
  /// Messages that record() was given.
  [[nodiscard]] virtual std::uint64_t messages() const = 0;
  /// Those of them that are in no file; after close().
  [[nodiscard]] virtual std::uint64_t lost() const = 0;
};
