// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <sound/wav.h>

namespace hc::audio {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are written as they are");

constexpr std::int64_t kHeaderBytes = 44, kMostBytes = 0xFFFFFFFF - kHeaderBytes;

using Header = std::array<std::byte, kHeaderBytes>;

Header header_of(const Format& format, std::int64_t data_bytes) {
  Header header{};
  std::size_t at = 0;
  auto add_name = [&](const char* name) {
    std::memcpy(header.data() + at, name, 4);
    at += 4;
  };
  auto add = [&](std::int64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) header[at++] = std::byte(value >> (8 * i) & 0xFF);
  };
  const std::int64_t frame = std::int64_t{2} * format.channels;
  add_name("RIFF");
  add(kHeaderBytes - 8 + data_bytes, 4);
  add_name("WAVE");
  add_name("fmt ");
  add(16, 4);
  add(1, 2);  // integers
  add(format.channels, 2);
  add(format.rate, 4);
  add(format.rate * frame, 4);
  add(frame, 2);
  add(16, 2);
  add_name("data");
  add(data_bytes, 4);
  return header;
}

}  // namespace

Result<WavWriter> WavWriter::create(const std::string& path, const Format& format) {
  auto file = HC_TRY(begin_file(path));
  WavWriter writer(std::move(file), format);
  // A file written in place, such as /dev/stdout, is open for appending, which would prevent
  // rewriting the header.
  const int descriptor = writer.file_.descriptor.get();
  ::fcntl(descriptor, F_SETFL, 0);
  writer.begin_ = std::max<std::int64_t>(0, ::lseek(descriptor, 0, SEEK_END));
  HC_TRY(writer.put_header());
  return writer;
}

Status WavWriter::put(std::span<const std::byte> bytes, std::int64_t at) {
  while (!bytes.empty()) {
    const ssize_t size = ::pwrite(file_.descriptor.get(), bytes.data(), bytes.size(), begin_ + at);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0)
      return Error{Code::System, path() + ": " + std::generic_category().message(errno)};
    bytes = bytes.subspan(static_cast<std::size_t>(size));
    at += size;
  }
  return {};
}

Status WavWriter::put_header() {
  return put(header_of(format_, data_bytes_), 0);
}

Status WavWriter::write(std::span<const std::int16_t> samples) {
  const auto bytes = std::as_bytes(samples);
  const auto size = static_cast<std::int64_t>(bytes.size());
  if (size > kMostBytes - data_bytes_)
    return Error{Code::TooLarge, path() + ": a WAV file is limited to 4 GiB"};
  // The samples first, so that the header is valid at any time.
  HC_TRY(put(bytes, kHeaderBytes + data_bytes_));
  data_bytes_ += size;
  return put_header();
}

}  // namespace hc::audio
