// SPDX-License-Identifier: Apache-2.0
#include <hosts/ssh.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <vector>

namespace hc::hosts {
namespace {

/// For ssh to connect and the agent to send its first message.
constexpr std::chrono::milliseconds kGreeting{20000};
constexpr std::size_t kMostErrors = 4096;  // [byte]
constexpr std::string_view kHowToInstall =
    R"(; install Hypercolumn there, or set the path of its hc: hc = "PATH")";

/// Quotes a word for a shell, except for a leading ~/.
std::string quoted(const std::string& word) {
  std::string text = word.starts_with("~/") ? "~/'" : "'";
  for (char c : word.substr(text.size() - 1)) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::vector<std::string> command_for(const GraphHost& host) {
  // No terminal, prompts, forwarding or sharing; detects a broken network.
  std::vector<std::string> words = {"ssh", "-T", "-x", "-a"};
  for (const char* option :
       {"BatchMode=yes", "ConnectTimeout=10", "ServerAliveInterval=1", "ServerAliveCountMax=3",
        "ClearAllForwardings=yes", "ControlMaster=no", "RemoteCommand=none", "EscapeChar=none"})
    words.insert(words.end(), {"-o", option});
  for (const auto& word : host.ssh) words.push_back(word.value);
  words.push_back("exec " + quoted(host.program.value) + " agent");
  return words;
}

/// The last non-empty line of a text, with control characters replaced.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r' || text.back() == ' '))
    text.pop_back();
  std::string line = text.substr(text.rfind('\n') + 1);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return line;
}

}  // namespace

Result<std::unique_ptr<Ssh>> Ssh::start(Loop& loop, const GraphHost& host,
                                        Conversation::Callbacks callbacks) {
  std::unique_ptr<Ssh> ssh(
      new Ssh(HC_TRY(Process::start(command_for(host), Process::Capture::Both))));
  HC_TRY(ssh->open(loop, std::move(callbacks)));
  return ssh;
}

Status Ssh::open(Loop& loop, Conversation::Callbacks callbacks) {
  readable_ = HC_TRY(loop.watch(process_.errors(), EPOLLIN, [this](auto) { read_errors(); }));
  conversation_ = HC_TRY(Conversation::make(loop, process_.output(), process_.input(), kGreeting,
                                            std::move(callbacks)));
  return {};
}

void Ssh::greeted() {
  is_greeted_ = true;
  errors_.clear();
}

void Ssh::read_errors() {
  std::array<char, kMostErrors> piece;
  const ssize_t size = ::read(process_.errors(), piece.data(), piece.size());
  if (size == 0) readable_.reset();
  if (size <= 0) return;
  errors_.append(piece.data(), static_cast<std::size_t>(size));
  if (errors_.size() > kMostErrors) errors_.erase(0, errors_.size() - kMostErrors);
}

std::string Ssh::reason_of(const std::string& observed) {
  read_errors();
  std::string error = last_line(errors_);
  const auto contains = [&](std::string_view words) { return error.find(words) != error.npos; };
  const bool has_ssh = !error.starts_with("exec(");  // otherwise ssh is missing here
  if (!is_greeted_ && has_ssh && (contains("not found") || contains("No such file")))
    return error + std::string(kHowToInstall);
  if (!error.empty()) return error;
  const bool is_noise = !is_greeted_ && observed.starts_with(Conversation::kNoMessage);
  return observed + (is_noise ? "; start-up files of the shell there, such as ~/.bashrc, must "
                                "print nothing"
                              : "");
}

bool Ssh::is_out_of_reach() {
  read_errors();
  // Its status is 255 whatever failed; of its messages, only those about a name or a connection
  // begin like this (sshconnect.c).
  return !is_greeted_ && ("\n" + errors_).find("\nssh: ") != std::string::npos;
}

}  // namespace hc::hosts
