// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <array>
#include <optional>

#include <graph/log_limit.h>
#include <graph/module_process.h>
#include <graph/plan.h>
#include <graph/process.h>
#include <graph/run/announcer.h>
#include <graph/run/held_names.h>
#include <hc/link/intake.h>

namespace hc {
namespace {

using internal::Announcer;
using internal::Intake;

constexpr std::size_t kPiece = std::size_t{64} << 10;  // default capacity of a pipe
constexpr int kLastPieces = 16;  // a pipe can be enlarged to 1 MiB; source: man 7 pipe
constexpr std::uint64_t kMaxReport = std::uint64_t{1} << 20;  // [byte]

class ProcessHere final : public ModuleProcess {
 public:
  ProcessHere(Loop& loop, int key, ModuleCallbacks callbacks)
      : loop_(loop), key_(key), callbacks_(std::move(callbacks)) {}

  Status listen(const std::string& manage_uri) {
    LinkOptions options;
    options.limits.element_bytes = kMaxReport;
    reports_ = HC_TRY(Intake::make(
        loop_, manage_uri, [this](const Message& message) { callbacks_.reported(message); },
        options));
    return {};
  }

  Status start(const std::vector<std::string>& command, const std::string& control_uri) override {
    if (control_uri.empty()) commands_.reset();
    if (!control_uri.empty() && !commands_)
      commands_ = HC_TRY(Announcer::make(loop_, control_uri, [this] {
        return process_ ? callbacks_.connected() : std::vector<Message>();
      }));
    HC_TRY(names_.hold(command));
    auto started =
        HC_TRY(Process::start(command, Process::Capture::Errors, {key_, names_.descriptors()}));
    auto output = HC_TRY(loop_.watch(started.output(), EPOLLIN, [this](auto) { read(); }));
    auto end = HC_TRY(loop_.watch(started.ended(), EPOLLIN, [this](auto) { check_end(); }));
    process_.emplace(std::move(started));
    output_ = std::move(output);
    end_ = std::move(end);
    return {};
  }

  [[nodiscard]] bool runs() const override { return process_.has_value(); }
  void ask_to_end() override {
    if (process_) process_->ask_to_end();
  }
  void kill() override {
    if (process_) process_->kill();
  }

  void check_end() override {
    const auto status = process_ ? process_->poll_status() : std::nullopt;
    if (!status) return;
    reports_->take_rest();
    // Read its last lines. Not until the end of the pipe: another process may keep it open.
    for (int piece = 0; piece < kLastPieces && output_; ++piece) read();
    output_.reset();
    end_.reset();
    process_.reset();
    processes_.clear();
    memory_.reset();
    if (commands_) commands_->disconnect_all();
    callbacks_.ended(*status);
  }

  void release_names() override { names_.release(); }

  [[nodiscard]] bool is_listening() const override {
    return process_ && commands_ && commands_->has_peers();
  }
  bool send(const Message& command) override { return !commands_ || commands_->send(command); }

  [[nodiscard]] pid_t number() const override { return process_ ? process_->number() : 0; }
  Usage usage(bool with_memory) override {
    if (!process_) return {};
    with_memory = with_memory || !memory_;
    if (with_memory) processes_ = descendants(process_->guard_number());
    auto usage = usage_of(processes_, with_memory);
    if (with_memory) memory_ = usage.memory;
    usage.memory = *memory_;
    return usage;
  }

 private:
  /// Reads one piece of its log per turn, so that endless output does not block the loop; pauses
  /// above the limit.
  void read() {
    static thread_local std::array<char, kPiece> piece;
    static_cast<void>(output_.want(EPOLLIN));
    const ssize_t size = ::read(process_->output(), piece.data(), piece.size());
    if (size == 0) output_.reset();
    if (size <= 0 || callbacks_.wrote({piece.data(), static_cast<std::size_t>(size)})) return;
    static_cast<void>(output_.want(0));
    output_.call_at(std::chrono::steady_clock::now() + LogLimit::kPause);
  }

  Loop& loop_;
  const int key_;
  const ModuleCallbacks callbacks_;
  std::unique_ptr<Intake> reports_;
  std::unique_ptr<Announcer> commands_;
  internal::HeldNames names_;
  std::optional<Process> process_;
  std::vector<pid_t> processes_;         // as last found
  std::optional<std::uint64_t> memory_;  // as last measured
  Loop::Handle output_, end_;
};

}  // namespace

Result<std::unique_ptr<ModuleProcess>> make_process_here(Loop& loop, const std::string& manage_uri,
                                                         int key, ModuleCallbacks callbacks) {
  auto made = std::make_unique<ProcessHere>(loop, key, std::move(callbacks));
  HC_TRY(made->listen(manage_uri));
  return std::unique_ptr<ModuleProcess>(std::move(made));
}

Result<std::shared_ptr<void>> read_in_place_here(Loop& loop, std::string reader_uri, int key) {
  // The key has another descriptor here than in modules.
  if (const auto at = reader_uri.find(kKeyFile); at != std::string::npos && key >= 0)
    reader_uri.replace(at, kKeyFile.size(), "/proc/self/fd/" + std::to_string(key));
  auto uri = HC_TRY(parse_uri(reader_uri));
  constexpr std::array<std::string_view, 4> kNeeded = {"same_user", "key", "peer", "interface"};
  std::erase_if(uri.options, [&](const auto& option) {
    return std::find(kNeeded.begin(), kNeeded.end(), option.first) == kNeeded.end();
  });
  uri.options.emplace_back("reconnect", "86400");
  if (uri.scheme == "shm" || uri.scheme == "dds") uri.options.emplace_back("keep", "latest");
  auto reader = HC_TRY(Intake::make(
      loop, uri.text(), [](const Message&) {}, {}, false));
  return std::shared_ptr<void>(std::move(reader));
}

}  // namespace hc
