// SPDX-License-Identifier: Apache-2.0
#pragma once
// Processes that a test starts, talks to and kills: the test's own program in another role. Each
// has a socket to the test, over which both say lines.

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include <hc/os/descriptor.h>

namespace hc::testing {

class Child {
 public:
  /// Where a child finds its socket to the test.
  static constexpr int kSocket = 3;

  Child() = default;
  /// Starts this program with `arguments`.
  /// @param crash_at  what HC_CRASH_AT says in it; empty: nothing.
  explicit Child(const std::vector<std::string>& arguments, const std::string& crash_at = "");
  Child(Child&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)),
        socket_(std::move(other.socket_)),
        heard_(std::move(other.heard_)) {}
  Child& operator=(Child&& other) noexcept;
  ~Child() { kill(); }

  [[nodiscard]] pid_t pid() const { return pid_; }

  void say(const std::string& line) const;
  /// The next line of the child, waited for; empty when it has ended.
  std::string line();
  /// The place of the first message behind `place` that this reader gets; what it says of links
  /// that ended is passed over.
  std::int64_t first_behind(std::int64_t place);
  /// Waits `microseconds`, or until the child says something or ends.
  void look(std::int64_t microseconds) const;

  /// Ends it as `kill -9`, if it has not ended; does not ask how it ended.
  void kill();
  void signal(int number) const;
  /// Stops it, and waits until it has stopped.
  void freeze() const;
  /// Waits for its end; as waitpid().
  int wait();
  /// Asks it to end.
  void stop() const;
  /// The same, and waits until it has done so well; what its last line was.
  std::string finish();

  /// How many of its open descriptors and mappings are shared memory of links.
  [[nodiscard]] int shared_memories() const;
  [[nodiscard]] int descriptors() const;
  /// How much memory there is behind the shared memory that it has made. [byte]
  [[nodiscard]] std::int64_t memory_made() const;

 private:
  pid_t pid_ = -1;
  Descriptor socket_;
  std::string heard_;
};

/// The child's side: the next line, if there is one now; `ended` when the test wants no more.
std::string command(bool& ended);
void report(const std::string& line);

}  // namespace hc::testing
