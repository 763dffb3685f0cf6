// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>
#include <system_error>

#include <sound/wav.h>

namespace hc::audio {
namespace {

constexpr int kMostChunks = 1000;  // before the samples; more are probably malicious
constexpr int kLeastRate = 1000, kMostRate = 384000;
constexpr std::uint32_t kPcm = 1, kFloat = 3, kExtensible = 0xFFFE;

std::uint32_t number(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return value;
}

std::string_view name_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), 4};
}

Error malformed(const std::string& path, const std::string& what) {
  return {Code::Malformed, path + ": " + what};
}

std::int16_t from_float(float value) {
  if (!(std::abs(value) <= 1)) value = std::isnan(value) ? 0 : std::copysign(1.0F, value);
  return static_cast<std::int16_t>(std::lround(value * 32767));
}

/// The upper 16 bits of an integer sample.
std::int16_t from_integer(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
  if (size == 1)  // only 8-bit samples are unsigned: 128 is silence
    return static_cast<std::int16_t>((static_cast<int>(number(bytes, at, 1)) - 128) * 256);
  return static_cast<std::int16_t>(number(bytes, at + size - 2, 2));
}

}  // namespace

Result<WavReader> WavReader::open(const std::string& path) {
  WavReader reader;
  reader.path_ = path;
  // Without O_NONBLOCK, open() would wait for the writer of a FIFO.
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file >= 0) reader.file_.reset(::fdopen(file, "rb"));
  if (reader.file_ == nullptr)
    return Error{errno == ENOENT ? Code::NotFound : Code::System,
                 path + ": " + std::generic_category().message(errno)};
  struct stat about {};
  if (::fstat(fileno(reader.file_.get()), &about) != 0 || !S_ISREG(about.st_mode))
    return malformed(path, "not a regular file");
  HC_TRY(reader.read_header(about.st_size));
  return reader;
}

Status WavReader::read_header(std::int64_t file_size) {
  std::array<std::byte, 12> riff{};
  if (std::fread(riff.data(), 1, riff.size(), file_.get()) != riff.size() ||
      name_of(riff) != "RIFF" || name_of(std::span(riff).subspan(8)) != "WAVE")
    return malformed(path_, "not a WAV file");
  std::int64_t at = riff.size();
  for (int i = 0; i < kMostChunks; ++i) {
    std::array<std::byte, 8> head{};
    if (std::fread(head.data(), 1, head.size(), file_.get()) != head.size())
      return malformed(path_, "has no samples");
    at += static_cast<std::int64_t>(head.size());
    const std::int64_t size = number(head, 4, 4);
    if (name_of(head) == "data") {
      if (sample_bytes_ == 0) return malformed(path_, "samples before their format");
      // Programs that write a file as a stream often leave 0 or the largest number here.
      const std::int64_t left = file_size - at;
      const std::int64_t there = size == 0 ? left : std::min(size, left);
      const auto frame = static_cast<std::int64_t>(sample_bytes_) * format_.channels;
      frames_ = there / frame;
      return {};
    }
    if (size > file_size - at) return malformed(path_, "a chunk is larger than the file");
    std::int64_t skipped = size + size % 2;  // a chunk starts at an even byte
    if (name_of(head) == "fmt ") {
      std::array<std::byte, 40> chunk{};
      const auto taken = std::min<std::size_t>(chunk.size(), static_cast<std::size_t>(size));
      if (std::fread(chunk.data(), 1, taken, file_.get()) != taken)
        return malformed(path_, "truncated");
      HC_TRY(read_format(std::span(chunk).first(taken)));
      skipped -= static_cast<std::int64_t>(taken);
    }
    if (::fseeko(file_.get(), skipped, SEEK_CUR) != 0) return malformed(path_, "truncated");
    at += size + size % 2;
  }
  return malformed(path_, "has more than " + std::to_string(kMostChunks) + " parts");
}

Status WavReader::read_format(std::span<const std::byte> chunk) {
  if (chunk.size() < 16) return malformed(path_, "the format is truncated");
  std::uint32_t kind = number(chunk, 0, 2);
  if (kind == kExtensible) {
    if (chunk.size() < 26) return malformed(path_, "the format is truncated");
    kind = number(chunk, 24, 2);
  }
  const std::uint32_t channels = number(chunk, 2, 2), rate = number(chunk, 4, 4);
  const std::uint32_t frame_bytes = number(chunk, 12, 2), bits = number(chunk, 14, 2);
  if (channels < 1 || channels > kMostChannels)
    return malformed(path_, std::to_string(channels) + " channels, not 1 to 8");
  if (rate < kLeastRate || rate > kMostRate)
    return malformed(path_, "a rate of " + std::to_string(rate) + " Hz");
  const bool is_known = (kind == kPcm && (bits == 8 || bits == 16 || bits == 24 || bits == 32)) ||
                        (kind == kFloat && bits == 32);
  if (!is_known)
    return Error{Code::Unsupported, path_ + ": samples of kind " + std::to_string(kind) + " with " +
                                        std::to_string(bits) + " bits"};
  if (frame_bytes != channels * bits / 8)
    return malformed(path_, "frames of " + std::to_string(frame_bytes) + " bytes, not " +
                                std::to_string(channels * bits / 8));
  format_ = {static_cast<int>(rate), static_cast<int>(channels)};
  sample_bytes_ = bits / 8;
  is_float_ = kind == kFloat;
  return {};
}

Result<std::size_t> WavReader::read(std::span<std::int16_t> samples) {
  const auto channels = static_cast<std::size_t>(format_.channels);
  const auto wanted = std::min(samples.size() / channels, static_cast<std::size_t>(frames_ - at_));
  bytes_.resize(wanted * channels * sample_bytes_);
  const auto size = std::fread(bytes_.data(), 1, bytes_.size(), file_.get());
  if (std::ferror(file_.get()) != 0)
    return Error{Code::System, path_ + ": " + std::generic_category().message(errno)};
  const std::size_t frames = size / (channels * sample_bytes_);  // fewer if truncated meanwhile
  for (std::size_t i = 0; i < frames * channels; ++i) {
    const std::size_t at = i * sample_bytes_;
    samples[i] = is_float_ ? from_float(std::bit_cast<float>(number(bytes_, at, 4)))
                           : from_integer(bytes_, at, sample_bytes_);
  }
  at_ = frames == wanted ? at_ + static_cast<std::int64_t>(frames) : frames_;
  return frames;
}

}  // namespace hc::audio
