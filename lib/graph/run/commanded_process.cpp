// SPDX-License-Identifier: Apache-2.0
#include <graph/run/commanded_process.h>

#include <array>
#include <utility>

#include <hc/base/check.h>
#include <hc/contract/command.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

using Verb = ModuleCommand::Verb;

Message message_of(const ModuleCommand& command) {
  return make_rows(std::array{text(command)});
}

ModuleCommand wall_offset_command(std::chrono::nanoseconds offset) {
  return {Verb::WallOffset, true, std::to_string(offset.count()), {}};
}

}  // namespace

CommandedProcess::CommandedProcess(Loop& loop, Hosts* hosts, const PlannedModule& plan,
                                   const OpenedPorts& opened, ModuleCallbacks callbacks)
    : loop_(loop),
      hosts_(hosts),
      plan_(plan),
      known_(plan),
      opened_(opened),
      callbacks_(std::move(callbacks)) {
  callbacks_.connected = [this] { return catch_up(); };
}

/// Null: this host, or one that is unknown.
std::shared_ptr<Host> CommandedProcess::host_of_plan() const {
  return hosts_ == nullptr || plan_.host.empty() ? nullptr : hosts_->find(plan_.host);
}

Status CommandedProcess::place() {
  const auto host = host_of_plan();
  HC_CHECK(host != nullptr || plan_.host.empty(), plan_.name, plan_.host);
  if (process_ && host == host_) return {};
  std::unique_ptr<ModuleProcess> made;
  if (host) {
    made = host->make_process(plan_, callbacks_);
  } else {
    made = HC_TRY(make_process_here(loop_, plan_.manage_uri, hosts_ == nullptr ? -1 : hosts_->key(),
                                    callbacks_));
  }
  // The old one, on another host, may be the caller of this function.
  if (process_) loop_.post([before = std::shared_ptr(std::move(process_))] {});
  process_ = std::move(made);
  host_ = host;
  return {};
}

bool CommandedProcess::is_host_connected() const {
  const auto host = host_of_plan();
  return host ? host->state().is_connected : plan_.host.empty();
}

Status CommandedProcess::start(PlannedModule plan) {
  finished_.clear();
  wall_offset_ = {};
  if (host_ && takes_commands()) {
    wall_offset_ = host_->wall_offset();
    plan.add_option("--wall_offset", std::to_string(wall_offset_.count()));
  }
  HC_TRY(process_->start(plan.command(), plan.control_uri));
  known_ = plan_;
  return {};
}

ModuleChange CommandedProcess::change_to(const PlannedModule& next) const {
  auto change = change_between(process_->is_listening() ? known_ : plan_, next);
  change.needs_restart = change.needs_restart || change_between(known_, next).needs_restart;
  return change;
}

void CommandedProcess::note_change() {
  if (process_->is_listening()) update_known();
}

/// The process knows the plan. It keeps the URIs under which it knows its links.
void CommandedProcess::update_known() {
  auto ends = std::exchange(known_, plan_).ends;
  for (auto& end : known_.ends)
    for (const auto& before : ends)
      if (is_same_end(end, before)) end.uri = before.uri;
}

/// The commands for a process that has just connected: changes since its start.
std::vector<Message> CommandedProcess::catch_up() {
  const auto change = change_between(known_, plan_);
  std::vector<Message> commands;
  auto add = [&](const ModuleCommand& command) { commands.push_back(message_of(command)); };
  for (const auto* some : {&change.unlinks, &change.outputs, &change.inputs})
    for (const auto& command : *some) add(command);
  for (const auto& input : finished_) add({Verb::Finish, true, input, {}});
  for (const auto& link : opened_.links()) add(link);
  if (wall_offset_.count() != 0) add(wall_offset_command(wall_offset_));
  update_known();
  return commands;
}

bool CommandedProcess::send(const ModuleCommand& command) {
  return !process_->is_listening() || process_->send(message_of(command));
}

std::optional<ModuleCommand> CommandedProcess::finish_input(const PlannedEnd& end,
                                                            bool is_finished) {
  const std::string what = end.text();
  if (is_finished && finished_.insert(what).second)
    return ModuleCommand{Verb::Finish, true, what, {}};
  if (!is_finished && finished_.erase(what) != 0) return ModuleCommand{Verb::Link, true, what, {}};
  return std::nullopt;
}

std::optional<ModuleCommand> CommandedProcess::correct_clock() {
  constexpr std::chrono::microseconds kNear{20};
  if (!takes_commands() || !host_ || !process_->runs() || !host_->state().is_connected)
    return std::nullopt;
  const auto offset = host_->wall_offset();
  if (std::chrono::abs(offset - wall_offset_) < kNear) return std::nullopt;
  wall_offset_ = offset;
  return wall_offset_command(offset);
}

}  // namespace hc::internal
