// SPDX-License-Identifier: Apache-2.0
#include <hosts/key_file.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <hc/os/program.h>

namespace hc::hosts {

Result<Descriptor> make_key_file(std::string_view key) {
  auto file = HC_TRY(open_descriptor("memfd_create", "key", [] {
    return ::memfd_create("hypercolumn key", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  }));
  constexpr mode_t kOwnerOnly = 0600;
  HC_TRY(system_call("fchmod", "key", [&] { return ::fchmod(file.get(), kOwnerOnly); }));
  HC_TRY(write_all(file.get(), key));
  // Modules share it, and none may change it for the others.
  HC_TRY(system_call("fcntl", "key", [&] {
    constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;
    return ::fcntl(file.get(), F_ADD_SEALS, kSeals);
  }));
  return file;
}

}  // namespace hc::hosts
