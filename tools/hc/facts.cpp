// SPDX-License-Identifier: Apache-2.0
// Each thing is tried as hc and the links do it, since versions of kernels promise little in
// containers.
#include "facts.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <linux/membarrier.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/sysinfo.h>
#include <sys/un.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "common.h"

namespace tool {
namespace {

namespace fs = std::filesystem;

/// Closes a descriptor at the end; -1 is none.
struct Held {
  explicit Held(int descriptor) : number(descriptor) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    if (number >= 0) ::close(number);
  }
  int number;
};

Feature feature(std::string name, bool works) {
  const int error = errno;
  return {std::move(name), works ? "" : std::strerror(error)};
}

bool seals_memory() {
  Held memory(::memfd_create("hypercolumn", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  return memory.number >= 0 && ::fcntl(memory.number, F_ADD_SEALS,
                                       F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE) == 0;
}

bool opens_pidfd() {
  return Held(static_cast<int>(::syscall(SYS_pidfd_open, ::getpid(), 0))).number >= 0;
}

bool has_membarrier() {
  auto commands = ::syscall(SYS_membarrier, MEMBARRIER_CMD_QUERY, 0, 0);
  if (commands < 0) return false;
  errno = ENOTSUP;
  return (commands & MEMBARRIER_CMD_GLOBAL_EXPEDITED) != 0;
}

bool has_futex() {
  std::uint32_t word = 0;
  return ::syscall(SYS_futex, &word, FUTEX_WAKE, 1, nullptr, nullptr, 0) == 0;
}

bool has_abstract_sockets() {
  Held socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::string name = "hypercolumn doctor " + std::to_string(::getpid());
  std::copy(name.begin(), name.end(), address.sun_path + 1);  // behind the NUL that makes it so
  auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return socket.number >= 0 &&
         ::bind(socket.number, reinterpret_cast<const sockaddr*>(&address), size) == 0;
}

bool opens(const std::string& path, int flags) {
  return Held(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)).number >= 0;
}

std::vector<Feature> kernel_features() {
  std::vector<Feature> features;
  features.push_back(feature("memfd with seals", seals_memory()));
  features.push_back(feature("pidfd", opens_pidfd()));
  features.push_back(feature("membarrier", has_membarrier()));
  features.push_back(feature("futex", has_futex()));
  features.push_back(feature("abstract sockets", has_abstract_sockets()));
  for (const char* path : {"/proc/net/unix", "/proc/thread-self/children", "/proc/self/fd"})
    features.push_back(feature(path, opens(path, O_RDONLY)));
  return features;
}

std::uint64_t limit_of(__rlimit_resource resource) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<std::uint64_t>::max();
  return limit.rlim_cur;
}

/// Memory that programs can still have, with what the kernel would give back. [byte]
std::uint64_t free_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (std::uint64_t kilobytes = 0; file >> key >> kilobytes;) {
    if (key == "MemAvailable:") return kilobytes * 1024;
    std::getline(file, unit);
  }
  return 0;
}

std::size_t processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return static_cast<std::size_t>(CPU_COUNT(&set));
}

/// The files of a folder whose names begin with one of these words and end with a digit.
std::vector<Device> devices(const std::string& folder,
                            std::initializer_list<std::string_view> beginnings, int access) {
  std::vector<Device> found;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    const std::string name = entry.path().filename().string();
    if (std::any_of(beginnings.begin(), beginnings.end(), [&](std::string_view beginning) {
          return name.starts_with(beginning) && name.back() >= '0' && name.back() <= '9';
        }))
      found.push_back({entry.path().string(), ::access(entry.path().c_str(), access) == 0});
  }
  std::sort(found.begin(), found.end(), [](const Device& a, const Device& b) {
    return std::pair(a.path.size(), a.path) < std::pair(b.path.size(), b.path);
  });
  return found;
}

/// Whether a line of the mainboard leads to a chip: the kernel has names for more than there are.
bool is_real_line(const Device& device) {
  const auto name = fs::path(device.path).filename().string();
  if (!name.starts_with("ttyS")) return true;
  std::ifstream file("/sys/class/tty/" + name + "/type");
  int type = 0;
  return file >> type && type != 0;
}

std::vector<Device> sounds() {
  auto found = devices("/dev/snd", {"controlC"}, R_OK | W_OK);
  std::error_code missing;  // pcmC0D0p plays, pcmC0D0c hears
  for (const auto& entry : fs::directory_iterator("/dev/snd", missing))
    if (entry.path().filename().string().starts_with("pcm"))
      found.push_back({entry.path().string(), ::access(entry.path().c_str(), R_OK | W_OK) == 0});
  return found;
}

/// From lines like " 0 [Loopback       ]: Loopback - Loopback".
std::vector<std::string> sound_cards() {
  std::vector<std::string> names;
  std::ifstream file("/proc/asound/cards");
  for (std::string line; std::getline(file, line);)
    if (auto at = line.find("]: "); at != std::string::npos) names.push_back(line.substr(at + 3));
  return names;
}

std::string display() {
  for (const char* name : {"WAYLAND_DISPLAY", "DISPLAY"})
    if (const char* value = std::getenv(name); value != nullptr && *value != '\0')
      return std::string(name) + "=" + value;
  return "";
}

PathState look_at(const std::string& path) {
  PathState state;
  std::error_code missing;
  state.is_there = fs::exists(path, missing);
  state.is_folder = fs::is_directory(path, missing);
  state.is_readable = ::access(path.c_str(), R_OK) == 0;
  state.is_writable = ::access(path.c_str(), W_OK) == 0;
  return state;
}

/// Why nobody can listen there; empty: one can, as this did for a moment.
std::string try_to_listen(const std::string& port) {
  auto source = hc::open_source({"tcp-listen", port, {}}, hc::LinkOptions());
  return source ? "" : source.error().detail;
}

}  // namespace

Facts gather_facts(const std::vector<std::string>& paths, const std::vector<std::string>& ports) {
  Facts facts;
  facts.kernel = kernel_features();
  utsname system{};
  if (::uname(&system) == 0) facts.release = std::string(system.sysname) + " " + system.release;
  facts.descriptors = limit_of(RLIMIT_NOFILE);
  facts.processes = limit_of(RLIMIT_NPROC);
  facts.processors = processors();
  if (struct sysinfo memory{}; ::sysinfo(&memory) == 0)
    facts.memory = std::uint64_t{memory.totalram} * memory.mem_unit;
  facts.free_memory = free_memory();
  facts.cameras = devices("/dev", {"video"}, R_OK | W_OK);
  facts.sounds = sounds();
  facts.sound_cards = sound_cards();
  facts.serials = devices("/dev", {"ttyUSB", "ttyACM", "ttyS"}, R_OK | W_OK);
  std::erase_if(facts.serials, [](const Device& device) { return !is_real_line(device); });
  facts.joysticks = devices("/dev/input", {"js", "event"}, R_OK);
  facts.renderers = devices("/dev/dri", {"card", "render"}, R_OK | W_OK);
  facts.display = display();
  facts.has_graphviz = !find_program("dot").empty();
  for (const auto& name : module_names()) {
    bool starts = ::access((module_folder() / name).c_str(), X_OK) == 0;
    (starts ? facts.modules : facts.broken_modules).push_back(name);
  }
  for (const auto& path : paths) facts.paths[path] = look_at(path);
  for (const auto& port : ports) facts.ports[port] = try_to_listen(port);
  return facts;
}

}  // namespace tool
