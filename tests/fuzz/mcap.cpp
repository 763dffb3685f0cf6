// SPDX-License-Identifier: Apache-2.0
// Any file: what a recording in MCAP says of itself and its metadata are read, and reading it ends:
// each of its records, all its messages and those of one stream, with messages that can be written,
// or with errors that can be read on after.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <hc/mtp/codec.h>
#include <record/reader.h>

namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 20;  // of elements, chunks, a summary [byte]

/// Reads whatever messages and metadata there are.
void read_records(const std::string& path) {
  auto reader = hc::mcap::Reader::open(path, {.chunk_bytes = kLimit, .summary_bytes = kLimit});
  if (!reader) return;
  static_cast<void>(reader->metadata());
  while (true) {
    const auto time = reader->next_time();
    const auto stored = time ? reader->next() : time.error();
    if (!stored && stored.error().code == hc::Code::Truncated) return;
    if (stored && !*stored) return;
    HC_CHECK(!stored || (*stored)->record.log_time == **time);
    HC_CHECK(reader->position() <= reader->size());
  }
}

/// Reads the messages of a recording, or of one of its streams; gives a stream that was in it.
std::string read_messages(const hc::record::Place& place) {
  hc::LinkOptions options;
  options.limits.element_bytes = kLimit;
  auto reader = hc::record::Reader::open({place}, options);
  if (!reader) return {};
  hc::Message message;
  std::string stream;
  while (true) {
    auto got = (*reader)->take(message);
    if (!got && got.error().code == hc::Code::Truncated) return stream;
    if (got && *got == hc::Got::End) return stream;
    if (got) {
      static_cast<void>(hc::encode(message));
      stream = (*reader)->stream();
      HC_CHECK(place.stream.empty() || place.stream == stream);
    } else {
      HC_CHECK((*reader)->resume().has_value());
    }
  }
}

}  // namespace

int fuzz_mcap(const std::uint8_t* data, std::size_t size) {
  static const int kFile = ::memfd_create("fuzz", MFD_CLOEXEC);
  HC_CHECK(kFile >= 0 && ::ftruncate(kFile, 0) == 0);
  HC_CHECK(::pwrite(kFile, data, size, 0) == static_cast<ssize_t>(size));
  const std::string path = "/proc/self/fd/" + std::to_string(kFile);
  read_records(path);
  using Kind = hc::record::Place::Kind;
  const std::string stream = read_messages({Kind::Mcap, path, "", {}});
  if (!stream.empty()) read_messages({Kind::Mcap, path, stream, {}});
  return 0;
}
