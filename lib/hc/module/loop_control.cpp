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

/// "PORT=URI" of a link at a port.
std::string text_of(const std::string& port, const std::string& uri) {
  return port + "=" + uri;
}

Status unknown_link() {
  return Error{Code::NotFound, "there is no such link"};
}

/// As a report has it: -1 of what is unknown.
std::int64_t number_of(std::optional<std::size_t> peers) {
  return peers ? static_cast<std::int64_t>(*peers) : -1;
}

/// What has come since the last report; the next begins with none.
Durations take_durations(internal::Quantiles& quantiles) {
  if (quantiles.empty()) return {-1, -1, -1};
  const Durations taken = {quantiles.quantile(0.5), quantiles.quantile(0.99), quantiles.max()};
  quantiles.clear();
  return taken;
}

}  // namespace

void Module::Loop::attend() {
  receive_focus();
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
  look_at_silent();
  for (const auto& command : std::exchange(deferred_, {})) obey(command);
  for (const auto& command : management_.take_commands()) obey(command);
  report();
  now_.read();  // commands may have taken their time
}

/// Has links notice that their writers have died: they look at that when they are waited for, and a
/// module that always has something to do waits for none.
void Module::Loop::look_at_silent() {
  for (auto* links : {&inlets_, &focus_})
    for (const auto& inlet : *links)
      if (inlet.source != nullptr && !inlet.head) inlet.source->prepare_wait();
}

void Module::Loop::receive_focus() {
  if (!focus_.empty() && !module_.message_time_) {  // else in its time
    Message message;
    for (auto& inlet : focus_)
      while (inlet.source != nullptr && take(inlet, message) == Got::Message)
        set_focus(inlet, message);
  }
  expire_focus();
}

void Module::Loop::set_focus(Inlet& inlet, const Message& message) {
  auto& focus = module_.focus_;
  const auto modes = message.view<std::int32_t>();
  if (!modes) return drop(inlet, internal::kFocusPort, modes.error().detail);
  if (modes->empty()) return drop(inlet, internal::kFocusPort, "it has no mode");
  trace_.note(TraceEvent::What::Took, internal::kFocusPort, message.header);
  focus.received = now_.time();
  if (std::exchange(focus.current, modes->at(0, 0)) != focus.current) report_state();
}

void Module::Loop::expire_focus() {
  if (module_.focus_.expire(now_.time())) report_state();
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
    if (link.is_focus) {
      std::erase_if(focus_, [uri = link.uri.text()](const auto& each) { return each.uri == uri; });
      open_focus(link.uri);
    } else if (is_input) {
      open_input(link.uri, {module_.inputs_[link.port].get()});
    } else {
      outlets_.open(link);
    }
  } catch (const ModuleError& error) {
    return Error{Code::System, error.what()};
  }
  return {};
}

Status Module::Loop::unlink(bool is_input, const std::string& text) {
  auto link = HC_TRY(internal::parse_port_link(module_, is_input, text));
  auto uri = link.uri.text();
  const auto outlet = is_input ? nullptr : outlets_.abandon(link);
  if (!is_input && outlet == nullptr) return unknown_link();
  report_counters();  // the last of this link
  if (!is_input) {
    outlets_.remove(link, outlet);
    return {};
  }
  // What is taken together with this input waits for the next link, and is not ended.
  const auto erased = std::erase_if(link.is_focus ? focus_ : inlets_, [&](const Inlet& each) {
    return each.uri == uri &&
           (link.is_focus || each.inputs.front() == module_.inputs_[link.port].get());
  });
  return erased == 0 ? unknown_link() : Status();
}

Status Module::Loop::finish(const std::string& text) {
  auto link = HC_TRY(internal::parse_port_link(module_, true, text));
  for (auto& each : link.is_focus ? focus_ : inlets_)
    if (each.uri == link.uri.text() && each.source != nullptr) each.source->finish();
  // That its writer has ended is no news then.
  opener_.drop_lines(link.uri.scheme + ":" + link.uri.rest + "?");
  return {};
}

/// Gives a link that there is, "PORT=URI", its route.
void Module::Loop::set_route(const std::string& link, const internal::Route& route) {
  for (auto& each : inlets_)
    for (const auto* input : each.inputs)
      if (text_of(input->name, each.uri) == link) each.route = route;
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
  for (auto& inlet : inlets_) {
    auto& counters = links.emplace_back();
    counters.traffic = inlet.traffic();
    counters.ignored = inlet.ignored;
    counters.peers = number_of(inlet.source ? inlet.source->peers() : std::nullopt);
    counters.age = take_durations(inlet.ages);
    counters.gap = take_durations(inlet.gaps);
    const auto& input = *inlet.inputs.front();
    if (input.together != nullptr && input.together->is_latest)
      counters.traffic.dropped_newer +=
          input.together->dropped_newer + input.together->matcher.dropped(input.place).total();
  }
  outlets_.add_counters(links);
  send(Report::Counters, make_counters(links));
}

void Module::Loop::report_links() {
  std::vector<LinkEnd> ends;
  for (const auto& inlet : inlets_)
    ends.push_back({true, inlet.inputs.size() == 1 ? inlet.inputs[0]->name : "-", inlet.uri});
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
