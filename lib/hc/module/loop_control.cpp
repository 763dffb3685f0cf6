// SPDX-License-Identifier: Apache-2.0
// A module's loop: the commands of who runs it, and the reports to them.

#include <algorithm>
#include <array>
#include <utility>

#include <hc/base/text.h>
#include <hc/contract/command.h>
#include <hc/module/loop.h>
#include <hc/mtp/rows.h>

namespace hc {
namespace {

using internal::Inlet;
using internal::Outlet;

/// How often a module that is busy looks for commands; one that waits is woken by them.
constexpr std::chrono::milliseconds kHousekeepingPeriod{10};

Status unknown_link() {
  return Error{Code::NotFound, "there is no such link"};
}

}  // namespace

void Module::Loop::attend() {
  if (module_.message_time_)
    delivery_.expire_focus();
  else
    inlets_.receive_focus();
  serve();
}

/// From time to time, obeys commands and reports.
void Module::Loop::serve() {
  outlets_.free_removed();
  opener_.log_lines(now_.machine);
  trace_.flush_if_due(now_.machine);
  const bool reports = management_.is_heard() && now_.machine - reported_ >= kReportPeriod;
  if (now_.machine - attended_ < kHousekeepingPeriod && deferred_.empty() && !reports) return;
  attended_ = now_.machine;
  if (module_.before_waiting_) module_.before_waiting_();
  // Links look for writers that have died when they are waited for, which a busy module never does.
  inlets_.for_each([](Inlet& inlet) {
    if (inlet.is_open()) inlet.source->prepare_wait();
  });
  for (const auto& command : std::exchange(deferred_, {})) obey(command);
  for (const auto& command : management_.take_commands()) obey(command);
  report();
  now_.read();  // commands may have taken their time
}

void Module::Loop::obey(const std::string& command) {
  if (command.empty()) return;
  auto done = carry_out(command);
  if (done) return;
  const std::string line = "command \"" + command + "\": " + done.error().detail;
  module_.log(line, Level::Warning);
}

/// Obeys commands while a sink waits within send(), as far as the handler that sends cannot notice:
/// what changes inputs, of which one may be in use, waits. False when no command comes any more.
bool Module::Loop::obey_while_sending() {
  using Verb = ModuleCommand::Verb;
  for (auto& row : management_.take_commands()) {
    const auto command = parse_module_command(row);
    bool is_deferred = false;
    if (command && command->verb == Verb::Route)  // of a link that is still to be opened
      is_deferred = std::find(deferred_.begin(), deferred_.end(),
                              text({Verb::Link, true, command->target, {}})) != deferred_.end();
    else if (command && command->verb != Verb::Set)
      is_deferred = command->is_input;
    if (is_deferred)
      deferred_.push_back(std::move(row));
    else
      obey(row);
  }
  return management_.commands() != nullptr;
}

Status Module::Loop::carry_out(const std::string& row) {
  const auto command = HC_TRY(parse_module_command(row));
  switch (command.verb) {
    case ModuleCommand::Verb::Set:
      return set_parameter(command.target, command.value);
    case ModuleCommand::Verb::Finish:
      return finish(command.target);
    case ModuleCommand::Verb::Route: {
      auto route = HC_TRY(internal::parse_route(command.value));
      set_route(command.target, route);
      return {};
    }
    case ModuleCommand::Verb::WallOffset: {
      std::int64_t wall_offset = 0;
      if (!read_number(command.target, wall_offset))
        return Error{Code::Invalid, "wall_offset needs a number of nanoseconds"};
      internal::distant_wall.set(wall_offset, module_.clock_.monotonic());
      now_.read_wall();
      return {};
    }
    case ModuleCommand::Verb::Link:
    case ModuleCommand::Verb::Unlink:
      break;
  }
  auto done = command.verb == ModuleCommand::Verb::Link ? link(command.is_input, command.target)
                                                        : unlink(command.is_input, command.target);
  if (done) report_links();
  return done;
}

Status Module::Loop::set_parameter(const std::string& name, const std::string& value) {
  for (auto& parameter : module_.parameters_) {
    if (parameter->name != name) continue;
    if (parameter->options.fixed)
      return Error{Code::Invalid, "parameter " + name + " is fixed while the module runs"};
    auto set = parameter->set(value);
    if (set) report_parameters();
    return set;
  }
  return Error{Code::Invalid, "no parameter \"" + name + "\""};
}

Status Module::Loop::link(bool is_input, const std::string& text) {
  auto link = HC_TRY(internal::parse_port_link(module_, is_input, text));
  // What cannot be opened is an error, and changes nothing.
  try {
    is_input ? inlets_.open(link) : outlets_.open(link);
  } catch (const ModuleError& error) {
    return Error{Code::System, error.what()};
  }
  return {};
}

Status Module::Loop::unlink(bool is_input, const std::string& text) {
  auto link = HC_TRY(internal::parse_port_link(module_, is_input, text));
  const auto outlet = is_input ? nullptr : outlets_.abandon(link);
  if (!is_input && outlet == nullptr) return unknown_link();
  report_counters();  // the last of this link
  if (!is_input) {
    outlets_.remove(link, outlet);
    return {};
  }
  return inlets_.remove(link) ? Status() : unknown_link();
}

Status Module::Loop::finish(const std::string& text) {
  auto link = HC_TRY(internal::parse_port_link(module_, true, text));
  inlets_.finish(link);
  // That its writer has ended is no news then.
  opener_.drop_lines(link.uri.scheme + ":" + link.uri.rest + "?");
  return {};
}

/// Gives a link that there is, "PORT=URI", its route.
void Module::Loop::set_route(const std::string& link, const internal::Route& route) {
  inlets_.set_route(link, route);
  outlets_.set_route(link, route);
}

void Module::Loop::send(Report report, Message message) {
  management_.send(report, std::move(message), module_.clock_.wall());
}

void Module::Loop::report() {
  if (!management_.is_heard() || now_.machine - reported_ < kReportPeriod) return;
  if (reported_.count() == 0) {
    report_state();
    report_links();
  }
  outlets_.count_peers();  // not in report_counters(), which may be called in send()
  report_counters();
}

/// Also where there is no link: that a module reports shows that it is not stuck.
void Module::Loop::report_counters() {
  reported_ = now_.machine;
  now_.read_wall();
  std::vector<LinkCounters> links;
  inlets_.add_counters(links);
  outlets_.add_counters(links);
  send(Report::Counters, make_counters(links));
}

void Module::Loop::report_links() {
  std::vector<LinkEnd> ends;
  inlets_.add_ends(ends);
  outlets_.add_ends(ends);
  send(Report::Links, make_links(ends));
}

void Module::Loop::report_parameters() {
  std::map<std::string, std::string> values;
  for (const auto& parameter : module_.parameters_)
    values[parameter->name] = text(parameter->value);
  send(Report::Parameters, make_parameters(values));
}

void Module::Loop::report_state(const Outlet* blocked) {
  // From its first report on a module counts as running, and a module that runs has parameters.
  if (reported_.count() == 0) report_parameters();
  const auto& focus = module_.focus_;
  const auto row = static_cast<std::int64_t>(inlets_.size() + outlets_.index_of(blocked) + 1);
  send(Report::State, make_state({focus.own, focus.decided != 0 ? focus.decided : focus.current,
                                  focus.in_focus(), blocked == nullptr ? 0 : row, focus.stops}));
}

}  // namespace hc
