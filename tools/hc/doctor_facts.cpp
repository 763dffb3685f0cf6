// SPDX-License-Identifier: Apache-2.0
// Features are tested by use: kernel versions say little about containers.
#include "doctor_facts.h"

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

#include <hc/base/natural_order.h>
#include <hc/os/descriptor.h>

#include "common.h"

namespace tool {
namespace {

namespace fs = std::filesystem;
using hc::Descriptor;

Feature feature(std::string name, bool works) {
  const int error = errno;
  return {std::move(name), works ? "" : std::strerror(error)};
}

bool seals_memory() {
  const Descriptor memory(::memfd_create("hypercolumn", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  return memory &&
         ::fcntl(memory.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE) == 0;
}

bool opens_pidfd() {
  return bool(Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, ::getpid(), 0))));
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
  const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::string name = "hypercolumn doctor " + std::to_string(::getpid());
  std::copy(name.begin(), name.end(), address.sun_path + 1);  // a leading NUL: abstract
  auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return socket && ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), size) == 0;
}

bool opens(const std::string& path, int flags) {
  return bool(Descriptor(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)));
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

/// Memory available to programs, including what the kernel can reclaim. [byte]
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

/// Whether a ttyS has hardware: the kernel creates more of them than exist.
bool is_real_line(const std::string& name) {
  if (!name.starts_with("ttyS")) return true;
  std::ifstream file("/sys/class/tty/" + name + "/type");
  int type = 0;
  return file >> type && type != 0;
}

/// The files of a folder whose names begin with one of `begins`, and end with a digit or a letter
/// of `ends`.
Devices find(const char* kind, const char* where, const char* folder,
             std::initializer_list<std::string_view> begins, int access = R_OK | W_OK,
             std::string_view ends = "") {
  std::vector<std::string> found;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    const std::string name = entry.path().filename().string();
    const bool has_end =
        (name.back() >= '0' && name.back() <= '9') || ends.find(name.back()) != ends.npos;
    if (has_end && is_real_line(name) &&
        std::ranges::any_of(begins, [&](auto begin) { return name.starts_with(begin); }))
      found.push_back(entry.path().string());
  }
  std::ranges::sort(found, hc::natural_less);
  Devices devices{kind, where};
  for (const auto& path : found)
    (::access(path.c_str(), access) == 0 ? devices.open : devices.closed).push_back(path);
  return devices;
}

/// Parses lines like " 0 [Loopback       ]: Loopback - Loopback".
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

/// The names of files of weights; the weights of a .json are in a .bin.
std::vector<std::string> networks_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (const auto& path = entry.path();
        path.extension() == ".tflite" || path.extension() == ".bin")
      names.push_back(path.stem());
  std::ranges::sort(names);
  return names;
}

}  // namespace

std::string problem_of(const std::string& question) {
  const auto what = question.substr(0, question.find(' '));
  const auto place = question.substr(std::min(question.size(), what.size() + 1));
  if (what == "listen") {  // for a moment
    auto source = hc::open_source({"tcp-listen", place, {}}, hc::LinkOptions());
    return source ? "" : ": " + source.error().detail;
  }
  std::error_code missing;
  const bool is_written = what == "write";
  if (!fs::exists(place, missing)) return " does not exist";
  if (is_written && !fs::is_directory(place, missing)) return " is not a folder";
  if (::access(place.c_str(), is_written ? W_OK : R_OK) == 0) return "";
  return is_written ? " is not writable for this user" : " is not readable for this user";
}

Facts gather_facts(const std::vector<std::string>& questions) {
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
  facts.devices = {
      find("camera", "/dev/video*", "/dev", {"video"}),
      // pcmC0D0p: playback, pcmC0D0c: capture
      find("sound", "/dev/snd", "/dev/snd", {"controlC", "pcm"}, R_OK | W_OK, "pc"),
      find("serial", "/dev/ttyUSB*, ttyACM*, ttyS*", "/dev", {"ttyUSB", "ttyACM", "ttyS"}),
      find("joystick", "/dev/input/js*, event*", "/dev/input", {"js", "event"}, R_OK),
      find("graphics", "/dev/dri", "/dev/dri", {"card", "render"})};
  facts.sound_cards = sound_cards();
  facts.display = display();
  facts.has_graphviz = !find_program("dot").empty();
  for (const auto& name : module_names()) {
    bool starts = ::access((module_folder() / name).c_str(), X_OK) == 0;
    (starts ? facts.modules : facts.broken_modules).push_back(name);
  }
  facts.networks_folder = hc::graph_folder().parent_path() / "nets";
  facts.networks = networks_in(facts.networks_folder);
  for (const auto& question : questions) facts.problems[question] = problem_of(question);
  return facts;
}

}  // namespace tool
