// SPDX-License-Identifier: Apache-2.0
#include <hc/module/run.h>

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <utility>

#include <hc/module/loop.h>
#include <hc/os/program.h>

namespace hc {
namespace {

constexpr int kDone = 0, kFailure = 1, kUsage = 2;
constexpr int kBackgroundNice = 10;

}  // namespace

Module::Run::Run(Module& module, const std::vector<std::string>& words) : module_(module) {
  attempt([&] { begin(words); });
  if (loop_ == nullptr && !status_) status_ = kDone;  // stopped while its links opened
}

Module::Run::~Run() = default;

/// Does a part of the run. What it throws ends the run.
template <typename Work>
void Module::Run::attempt(const Work& work) {
  try {
    work();
  } catch (const internal::Stopped&) {
    is_stopped_ = true;
  } catch (const ModuleError& error) {
    error_ = error.what();
    status_ = error.is_usage ? kUsage : kFailure;
  } catch (const std::exception& error) {
    error_ = internal::thrown_in_words(error);
    status_ = kFailure;
  }
}

void Module::Run::begin(const std::vector<std::string>& words) {
  auto arguments = internal::parse_arguments(module_, words);
  if (!arguments) {
    error_ = arguments.error().text();
    status_ = kUsage;
    return;
  }
  arguments_ = std::make_unique<internal::Arguments>(std::move(*arguments));
  using Task = internal::Arguments::Task;
  if (arguments_->task != Task::Run) {
    const auto printed =
        write_all(STDOUT_FILENO, arguments_->task == Task::Help
                                     ? internal::help(module_)
                                     : to_json(internal::description_of(module_)) + "\n");
    if (!printed && printed.error().code != Code::Closed) throw ModuleError(printed.error());
    status_ = kDone;
    return;
  }
  if (!arguments_->instance.empty()) module_.instance_ = arguments_->instance;
  module_.message_time_.reset();
  if (arguments_->by_messages) module_.message_time_.emplace();
  if (module_.options_.background) {  // what is refused changes nothing but the speed
    static_cast<void>(::setpriority(PRIO_PROCESS, 0, kBackgroundNice));
    const sched_param none{};
    static_cast<void>(::sched_setscheduler(0, SCHED_BATCH, &none));
  }
  loop_ = std::make_unique<Loop>(module_, *arguments_, stop_descriptor());
  loop_->begin();
}

void Module::Run::work() {
  if (is_working()) attempt([&] { loop_->work(); });
}

std::optional<Message> Module::Run::next(internal::InputState& input) {
  std::optional<Message> message;
  if (is_working()) attempt([&] { message = loop_->next(input); });
  return message;
}

int Module::Run::end() {
  if (is_working()) attempt([&] { loop_->finish(); });
  if (!status_ && is_stopped_)
    attempt([&] { module_.options_.finish_when_stopped ? loop_->take_rest() : loop_->end(); });
  if (!status_) attempt([&] { loop_->close(); });
  // As has been logged. By the messages' clock a recording is repeated, with what was dropped then.
  if (!status_ && loop_->has_failed_input() && !arguments_->by_messages) status_ = kFailure;
  loop_.reset();
  if (!error_.empty()) module_.log(error_);
  module_.log_counts();
  return status_.value_or(kDone);
}

}  // namespace hc
