// SPDX-License-Identifier: Apache-2.0
#include <hosts/key_file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <hc/os/program.h>

namespace hc::hosts {

Result<internal::Descriptor> make_key_file(std::string_view key) {
  auto made = internal::system_call("memfd_create", "key", [] {
    return ::memfd_create("hypercolumn key", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  });
  if (!made) return made.error();
  internal::Descriptor file(*made);
  constexpr mode_t kOwnerOnly = 0600;
  auto closed = internal::system_call("fchmod", "key", [&] { return ::fchmod(*made, kOwnerOnly); });
  if (!closed) return closed.error();
  if (auto written = write_all(*made, key); !written) return written.error();
  // Modules have it too, and one must not change it for the others.
  auto sealed = internal::system_call("fcntl", "key", [&] {
    return ::fcntl(*made, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL);
  });
  if (!sealed) return sealed.error();
  return file;
}

}  // namespace hc::hosts
