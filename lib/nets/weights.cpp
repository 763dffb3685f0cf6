// SPDX-License-Identifier: Apache-2.0
#include <nets/weights.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <hc/base/format.h>

namespace hc::nets {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 64 << 20;  // of a file

/// Programs are in PREFIX/bin or PREFIX/libexec/hypercolumn, in a build in others as deep as that.
fs::path weights_folder() {
  const fs::path inside = fs::path("share") / "hypercolumn" / "nets";
  std::error_code unknown;
  const fs::path above = fs::read_symlink("/proc/self/exe", unknown).parent_path().parent_path();
  return fs::is_directory(above / inside, unknown) ? above / inside : above.parent_path() / inside;
}

}  // namespace

std::string weights_path(const std::string& name) {
  return weights_folder() / name;
}

Result<std::string> read_weights(const std::string& path) {
  const auto fails = [&](Code code, const std::string& why) {
    return Error{code, path + ": cannot be read: " + why};
  };
  std::error_code why;
  const auto size = fs::file_size(path, why);  // of a file, not of a pipe
  if (why == std::errc::no_such_file_or_directory) {
    const bool is_ours = fs::path(path).parent_path() == weights_folder();
    const char* remedy = "; the Debian package hypercolumn has it, and ./dev build unpacks it";
    return fails(Code::NotFound, why.message() + (is_ours ? remedy : ""));
  }
  if (why) return fails(Code::System, why.message());
  if (size > kMostBytes) return fails(Code::TooLarge, hc::format("more than {} bytes", kMostBytes));
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) return fails(Code::System, std::generic_category().message(errno));
  return bytes;
}

}  // namespace hc::nets
