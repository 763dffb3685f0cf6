// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sound in WAV files (RIFF, "Multimedia Programming Interface and Data Specifications 1.0", 1991).
// Files are not trusted: sizes are checked against the file's size.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/os/new_file.h>
#include <sound/format.h>

namespace hc::audio {

/// Reads integer samples of 8, 16, 24 or 32 bits and 32-bit floats, plain or "extensible", as i16.
class WavReader {
 public:
  /// Errors: NotFound (no such file), Malformed, Unsupported (another kind of samples), System.
  static Result<WavReader> open(const std::string& path);

  [[nodiscard]] const Format& format() const { return format_; }
  /// Sample frames actually in the file, whatever its header says.
  [[nodiscard]] std::int64_t frames() const { return frames_; }

  /// Reads the next sample frames; returns their number, 0 at the end.
  /// @param[out] samples  interleaved channels; room for whole frames.
  ///
  /// Errors: System.
  Result<std::size_t> read(std::span<std::int16_t> samples);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  WavReader() = default;
  Status read_header(std::int64_t file_size);
  Status read_format(std::span<const std::byte> chunk);

  std::unique_ptr<std::FILE, Close> file_;
  std::string path_;
  Format format_;
  std::int64_t frames_ = 0, at_ = 0;
  std::size_t sample_bytes_ = 0;
  bool is_float_ = false;
  std::vector<std::byte> bytes_;
};

/// Writes i16. The file is valid after every write(), so nothing is lost if the program crashes.
class WavWriter {
 public:
  /// Creates a file with begin_file(), which never overwrites one. Errors: as begin_file().
  static Result<WavWriter> create(const std::string& path, const Format& format);

  /// Errors: TooLarge (4 GiB are full), System.
  Status write(std::span<const std::int16_t> samples);

  [[nodiscard]] const std::string& path() const { return file_.path; }
  [[nodiscard]] const Format& format() const { return format_; }
  /// Sample frames in the file.
  [[nodiscard]] std::int64_t frames() const { return data_bytes_ / 2 / format_.channels; }

 private:
  WavWriter(NewFile file, const Format& format) : file_(std::move(file)), format_(format) {}
  Status put(std::span<const std::byte> bytes, std::int64_t at);
  Status put_header();

  NewFile file_;
  Format format_;
  std::int64_t begin_ = 0;  // offset of the header in the file
  std::int64_t data_bytes_ = 0;
};

}  // namespace hc::audio
