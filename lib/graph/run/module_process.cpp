// SPDX-License-Identifier: Apache-2.0
#include <graph/run/module_process.h>

namespace hc::internal {
namespace {

class ProcessHere final : public ModuleProcess {
 public:
  explicit ProcessHere(Process process)
      : process_(std::move(process)), number_(first_child(process_.guard_number())) {}

  [[nodiscard]] pid_t number() const override { return number_; }
  [[nodiscard]] int output() const override { return process_.output(); }
  [[nodiscard]] int ended() const override { return process_.ended(); }
  std::optional<int> poll_status() override { return process_.poll_status(); }
  void ask_to_end() override { process_.ask_to_end(); }
  void kill() override { process_.kill(); }
  Usage usage(bool with_memory) override {
    if (with_memory || processes_.empty()) processes_ = descendants(process_.guard_number());
    return usage_of(processes_, with_memory);
  }

 private:
  Process process_;
  pid_t number_;
  std::vector<pid_t> processes_;  // when they were last looked for
};

}  // namespace

Result<std::unique_ptr<ModuleProcess>> start_here(const std::vector<std::string>& command,
                                                  const Given& given) {
  auto process = Process::start(command, Process::Capture::Errors, given);
  if (!process) return process.error();
  return std::unique_ptr<ModuleProcess>(std::make_unique<ProcessHere>(std::move(*process)));
}

}  // namespace hc::internal
