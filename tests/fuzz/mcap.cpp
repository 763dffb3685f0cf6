// SPDX-License-Identifier: Apache-2.0
// Any file: what a recording in MCAP says of itself and its metadata are read, and reading it ends:
// each of its records, all its messages and those of one stream, with messages that can be written,
// or with errors that can be read on after.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <hc/mtp/codec.h>
#include <mcap/link.h>

namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 20;  // of elements, chunks, a summary [byte]

/// Reads whatever messages there are; gives the last metadata.
void read_records(const std::string& path) {
  auto reader = hc::mcap::Reader::open(path, {.chunk_bytes = kLimit, .summary_bytes = kLimit});
  if (!reader) return;
  if (const auto summary = reader->summary())
    static_cast<void>(reader->metadata(summary->first_metadata));
  while (true) {
    const auto stored = reader->next();
    if (!stored && stored.error().code == hc::Code::Truncated) return;
    if (stored && !*stored) return;
    HC_CHECK(reader->position() <= reader->size());
  }
}

/// Reads the messages of a recording, or of one of its streams; gives a stream that was in it.
std::string read_messages(const hc::Uri& uri) {
  hc::LinkOptions options;
  options.limits.element_bytes = kLimit;
  auto source = hc::mcap::read_recording(uri, options);
  if (!source) return {};
  hc::Message message;
  std::string stream;
  while (true) {
    auto got = (*source)->take(message);
    if (!got && got.error().code == hc::Code::Truncated) return stream;
    if (got && *got == hc::Got::End) return stream;
    if (got) {
      static_cast<void>(hc::encode(message));
      stream = hc::mcap::stream_of(**source);
      HC_CHECK(uri.option("stream", stream) == stream);
    } else {
      HC_CHECK((*source)->resume().has_value());
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
  const std::string stream = read_messages({"file", path, {}});
  if (!stream.empty()) read_messages({"file", path, {{"stream", stream}}});
  return 0;
}
