// SPDX-License-Identifier: Apache-2.0
// A bad network for tests: two Ethernet devices, and what comes out of either goes into the other,
// late, slowly, or not at all.
//
//     cable NAME NAME
//
// makes them (TAP) and prints a line. A line of standard input says how it goes on from there:
//
//     DELAY LOSS RATE      [ms] one way, [1] of packets, [byte/s] or 0 for any
//
// A LOSS of 1 is a cut. The end of standard input is that of the devices. What waits for its turn
// is at most 256 KiB each way, as in a router.
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostWaiting = std::size_t{256} << 10;  // [byte]
constexpr std::size_t kLongest = 65536;                       // packet [byte]

struct Quality {
  Clock::duration delay{0};
  double loss = 0;
  double rate = 0;
};

/// One way: what comes out of `from` goes into `to`.
class Way {
 public:
  Way(int from, int to, unsigned seed) : from_(from), to_(to), chance_(seed) {}

  [[nodiscard]] int descriptor() const { return from_; }

  void take(const Quality& quality) {
    std::vector<char> packet(kLongest);
    while (true) {
      packet.resize(kLongest);
      const ssize_t size = ::read(from_, packet.data(), packet.size());
      if (size <= 0) return;
      packet.resize(static_cast<std::size_t>(size));
      if (std::bernoulli_distribution(quality.loss)(chance_)) continue;
      if (waiting_bytes_ + packet.size() > kMostWaiting) continue;
      const auto now = Clock::now();
      free_ = std::max(free_, now);
      if (quality.rate > 0)
        free_ += std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(static_cast<double>(size) / quality.rate));
      waiting_bytes_ += packet.size();
      waiting_.push_back({std::max(free_ + quality.delay, last_), packet});
      last_ = waiting_.back().due;
    }
  }

  void give(Clock::time_point now) {
    for (; !waiting_.empty() && waiting_.front().due <= now; waiting_.pop_front()) {
      const auto& packet = waiting_.front().packet;
      waiting_bytes_ -= packet.size();
      // One that the device does not take is lost, as on any network.
      [[maybe_unused]] const auto size = ::write(to_, packet.data(), packet.size());
    }
  }

  [[nodiscard]] Clock::time_point due() const {
    return waiting_.empty() ? Clock::time_point::max() : waiting_.front().due;
  }

 private:
  struct Packet {
    Clock::time_point due;
    std::vector<char> packet;
  };

  int from_, to_;
  std::mt19937 chance_;
  std::deque<Packet> waiting_;
  std::size_t waiting_bytes_ = 0;
  Clock::time_point free_, last_;  // when the line is; when the last packet is due
};

int make_device(const char* name) {
  const int device = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  if (device >= 0 && ::ioctl(device, TUNSETIFF, &request) == 0) return device;
  std::perror("cable: /dev/net/tun");
  return -1;
}

/// What is said on standard input; false at its end.
bool listen(std::string& text, Quality& quality) {
  std::array<char, 256> piece{};
  const ssize_t size = ::read(STDIN_FILENO, piece.data(), piece.size());
  if (size <= 0) return false;
  text.append(piece.data(), static_cast<std::size_t>(size));
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    double delay = 0;
    std::istringstream(text) >> delay >> quality.loss >> quality.rate;
    quality.delay = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double, std::milli>(delay));
    text.erase(0, end + 1);
    std::puts("so be it");
    std::fflush(stdout);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int one = make_device(argv[1]), other = make_device(argv[2]);
  if (one < 0 || other < 0) return 1;
  std::puts("ready");
  std::fflush(stdout);
  std::array ways = {Way(one, other, 1), Way(other, one, 2)};
  Quality quality;
  std::string text;
  while (true) {
    const auto now = Clock::now();
    for (auto& way : ways) way.give(now);
    const auto due = std::min(ways[0].due(), ways[1].due());
    timespec timeout{};
    const auto left = std::max(Clock::duration(0), due - now);
    timeout.tv_sec = std::chrono::duration_cast<std::chrono::seconds>(left).count();
    timeout.tv_nsec = (left % std::chrono::seconds(1)).count();
    std::array<pollfd, 3> polled = {
        {{one, POLLIN, 0}, {other, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
    const bool is_idle = due == Clock::time_point::max();
    if (::ppoll(polled.data(), polled.size(), is_idle ? nullptr : &timeout, nullptr) < 0) return 1;
    for (auto& way : ways) way.take(quality);
    if (polled[2].revents != 0 && !listen(text, quality)) return 0;
  }
}
