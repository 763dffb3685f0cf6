// SPDX-License-Identifier: Apache-2.0
#include "child.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace hc::testing {
namespace {

[[noreturn]] void become(const std::vector<std::string>& arguments, const std::string& crash_at,
                         int socket) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (!crash_at.empty()) ::setenv("HC_CRASH_AT", crash_at.c_str(), 1);
  if (socket == Child::kSocket)
    ::fcntl(socket, F_SETFD, 0);
  else
    ::dup2(socket, Child::kSocket);
  std::string name = "/proc/self/exe";
  std::vector<std::string> copies = arguments;
  std::vector<char*> words{name.data()};
  for (auto& word : copies) words.push_back(word.data());
  words.push_back(nullptr);
  ::execv(name.c_str(), words.data());
  std::_Exit(127);
}

/// Takes a line out of what was heard; false when there is no whole one.
bool take_line(std::string& heard, std::string& line) {
  auto end = heard.find('\n');
  if (end == std::string::npos) return false;
  line = heard.substr(0, end);
  heard.erase(0, end + 1);
  return true;
}

int count_entries(const std::filesystem::path& folder) {
  std::error_code gone;
  int count = 0;
  for (auto entry = std::filesystem::directory_iterator(folder, gone);
       entry != std::filesystem::directory_iterator(); entry.increment(gone))
    ++count;
  return count;
}

}  // namespace

Child::Child(const std::vector<std::string>& arguments, const std::string& crash_at) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
  socket_ = Descriptor(ends[0]);
  Descriptor other(ends[1]);
  pid_ = ::fork();
  EXPECT_GE(pid_, 0);
  if (pid_ == 0) become(arguments, crash_at, other.get());
}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(socket_, other.socket_);
  std::swap(heard_, other.heard_);
  return *this;
}

void Child::say(const std::string& line) const {
  std::string text = line + "\n";
  ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
}

std::string Child::line() {
  std::string line;
  while (!take_line(heard_, line)) {
    std::array<char, 256> bytes;
    auto size = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    if (size <= 0) return "";
    heard_.append(bytes.data(), static_cast<std::size_t>(size));
  }
  return line;
}

std::int64_t Child::first_behind(std::int64_t place) {
  say("after " + std::to_string(place));
  std::string answer = line();
  while (answer.starts_with("end")) answer = line();
  EXPECT_FALSE(answer.empty());
  return answer.empty() ? 0 : std::stoll(answer);
}

void Child::look(std::int64_t microseconds) const {
  pollfd polled{socket_.get(), POLLIN, 0};
  timespec time{microseconds / 1'000'000, microseconds % 1'000'000 * 1000};
  ::ppoll(&polled, 1, &time, nullptr);
}

void Child::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

void Child::freeze() const {
  signal(SIGSTOP);
  int status = 0;
  EXPECT_EQ(::waitpid(pid_, &status, WUNTRACED), pid_);
  EXPECT_TRUE(WIFSTOPPED(status));
}

void Child::kill() {
  if (pid_ <= 0) return;
  signal(SIGKILL);
  wait();
}

int Child::wait() {
  int status = -1;
  if (pid_ > 0) {
    EXPECT_EQ(::waitpid(pid_, &status, 0), pid_);
  }
  pid_ = -1;
  return status;
}

void Child::stop() const {
  ::shutdown(socket_.get(), SHUT_WR);
}

std::string Child::finish() {
  stop();
  std::string last, next;
  while (!(next = line()).empty()) last = next;
  int status = wait();
  EXPECT_TRUE(WIFEXITED(status)) << "by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  return last;
}

int Child::shared_memories() const {
  std::ifstream maps("/proc/" + std::to_string(pid_) + "/maps");
  int count = 0;
  for (std::string line; std::getline(maps, line);)
    if (line.find("memfd:hypercolumn") != std::string::npos) ++count;
  return count;
}

int Child::descriptors() const {
  return count_entries("/proc/" + std::to_string(pid_) + "/fd");
}

std::int64_t Child::memory_made() const {
  namespace fs = std::filesystem;
  std::int64_t bytes = 0;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(pid_) + "/fd", gone)) {
    struct stat status {};
    if (fs::read_symlink(entry, gone).string().find("memfd:hypercolumn") != std::string::npos &&
        ::stat(entry.path().c_str(), &status) == 0)
      bytes = std::max<std::int64_t>(bytes, status.st_blocks * 512);
  }
  return bytes;
}

std::string command(bool& ended) {
  static std::string heard;
  std::string line;
  if (take_line(heard, line)) return line;
  std::array<char, 256> bytes;
  auto size = ::recv(Child::kSocket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (size == 0) ended = true;
  if (size > 0) heard.append(bytes.data(), static_cast<std::size_t>(size));
  take_line(heard, line);
  return line;
}

void report(const std::string& line) {
  std::string text = line + "\n";
  ::send(Child::kSocket, text.data(), text.size(), MSG_NOSIGNAL);
}

}  // namespace hc::testing
