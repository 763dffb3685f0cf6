// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/input_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

namespace hc::mcap {

Result<InputFile> InputFile::open(const std::string& path) {
  Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!descriptor) return system_error("open", path);
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) return system_error("fstat", path);
  if (!S_ISREG(status.st_mode))
    return Error{Code::Unsupported, path + ": a recording in MCAP is a file, not a pipe or device"};
  InputFile file(path, std::move(descriptor), static_cast<std::uint64_t>(status.st_size));
  const auto magic = file.read(0, kMagic.size(), kMagic.size());
  if (!magic && magic.error().code != Code::Truncated) return magic.error();
  if (!magic || std::memcmp(magic->data(), kMagic.data(), kMagic.size()) != 0)
    return Error{Code::Malformed, path + ": not an MCAP file"};
  return file;
}

Result<std::vector<std::byte>> InputFile::read(std::uint64_t at, std::uint64_t size,
                                               std::uint64_t limit) const {
  if (size > limit)
    return Error{Code::TooLarge, "MCAP: a record of " + std::to_string(size) + " bytes at byte " +
                                     std::to_string(at) + ", more than the limit of " +
                                     std::to_string(limit)};
  if (at > size_ || size > size_ - at) return truncated(at);
  std::vector<std::byte> bytes(size);
  for (std::size_t done = 0; done < bytes.size();) {
    const auto got = system_call("read", path_, [&] {
      return ::pread(descriptor_.get(), bytes.data() + done, bytes.size() - done,
                     static_cast<off_t>(at + done));
    });
    if (!got) return got.error();
    if (*got == 0) return truncated(at);  // the file has been truncated
    done += static_cast<std::size_t>(*got);
  }
  return bytes;
}

Result<RecordPlace> InputFile::record_at(std::uint64_t at) const {
  auto head = read(at, kRecordHead, kRecordHead);
  if (!head) return head.error();
  RecordPlace place{{}, at, 0};
  RecordReader(*head).get(place.opcode, place.length);
  if (place.length > size_ - place.content()) return truncated(at);
  return place;
}

Error InputFile::truncated(std::uint64_t at) const {
  return {Code::Truncated, "MCAP: the file is truncated, as after a crash; " + std::to_string(at) +
                               " of its " + std::to_string(size_) +
                               " bytes are complete and have been read"};
}

}  // namespace hc::mcap
