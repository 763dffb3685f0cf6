// SPDX-License-Identifier: Apache-2.0
#include <hc/module/remote.h>

#include <algorithm>
#include <map>
#include <utility>

#include <hc/base/text.h>
#include <hc/module/ending.h>
#include <hc/module/loop.h>

namespace hc {
namespace {

using Verb = ModuleCommand::Verb;

constexpr const char* kReportsKept = "64";  // for a slow reader
constexpr std::chrono::milliseconds kReportPeriod{500};

}  // namespace

void Module::Remote::open(const internal::Arguments& arguments) {
  std::unique_ptr<Sink> reports;
  if (arguments.manage) {
    Uri uri = *arguments.manage;
    if (uri.option("keep", "").empty()) uri.options.emplace_back("keep", kReportsKept);
    auto sink = open_sink(uri);  // it outlives the loop
    if (!sink) internal::fail(uri.text(), sink.error());
    reports = std::move(*sink);
  }
  module_.management_->open(std::move(reports), arguments.control
                                                    ? opener_.open(*arguments.control, "commands")
                                                    : nullptr);
}

MonotonicTime Module::Remote::due() const {
  if (!deferred_.empty()) return MonotonicTime(0);
  return module_.management_->is_heard() ? reported_ + kReportPeriod : MonotonicTime::max();
}

void Module::Remote::serve() {
  for (const auto& row : std::exchange(deferred_, {})) obey(row);
  for (const auto& row : module_.management_->take_commands()) obey(row);
  if (now_.machine < due()) return;
  if (reported_.count() == 0) {
    report_state();
    report_links();
  }
  outlets_.count_peers();  // not in report_counters(), which may be called within send()
  report_counters();
}

void Module::Remote::obey(const std::string& row) {
  if (row.empty()) return;
  const auto command = parse_module_command(row);
  const auto done = command ? carry_out(*command) : Status(command.error());
  if (!done) module_.log("command \"" + row + "\": " + done.error().detail, Level::Warning);
}

bool Module::Remote::obey_while_sending() {
  for (auto& row : module_.management_->take_commands()) {
    const auto command = parse_module_command(row);
    bool is_deferred = command && command->verb != Verb::Set && command->is_input;
    if (command && command->verb == Verb::Route)  // its link may be deferred
      is_deferred =
          std::ranges::count(deferred_, text({Verb::Link, true, command->target, {}})) > 0;
    if (is_deferred)
      deferred_.push_back(std::move(row));
    else
      obey(row);
  }
  return commands() != nullptr;
}

Status Module::Remote::carry_out(const ModuleCommand& command) {
  switch (command.verb) {
    case Verb::Set:
      return set_parameter(command.target, command.value);
    case Verb::Link:
      return link(command.is_input, command.target);
    case Verb::Unlink:
      return unlink(command.is_input, command.target);
    case Verb::Finish: {
      const auto link = HC_TRY(internal::parse_port_link(module_, true, command.target));
      inlets_.finish(link);
      // The writer's end is expected; do not log it.
      opener_.drop_lines(link.uri.scheme + ":" + link.uri.rest + "?");
      return {};
    }
    case Verb::Route: {
      const auto route = HC_TRY(internal::parse_route(command.value));
      inlets_.set_route(command.target, route);
      outlets_.set_route(command.target, route);
      return {};
    }
    case Verb::WallOffset:
      break;
  }
  std::int64_t wall_offset = 0;
  if (!read_number(command.target, wall_offset))
    return Error{Code::Invalid, "wall_offset needs a number of nanoseconds"};
  internal::distant_wall.set(std::chrono::nanoseconds(wall_offset), module_.clock_.monotonic());
  now_.read_wall();
  return {};
}

Status Module::Remote::set_parameter(const std::string& name, const std::string& value) {
  for (auto& parameter : module_.parameters_) {
    if (parameter->name != name) continue;
    if (parameter->options.fixed)
      return Error{Code::Invalid, "parameter " + name + " is fixed while the module runs"};
    HC_TRY(parameter->set(value));
    module_.loop_->trace.note_set(name, value);
    report_parameters();
    return {};
  }
  return Error{Code::Invalid, "no parameter \"" + name + "\""};
}

Status Module::Remote::link(bool is_input, const std::string& text) {
  const auto link = HC_TRY(internal::parse_port_link(module_, is_input, text));
  try {
    is_input ? inlets_.open(link) : outlets_.open(link);
  } catch (const ModuleError& error) {
    return Error{Code::System, error.what()};
  }
  note(TraceEvent::What::Linked, is_input, link);
  report_links();
  return {};
}

Status Module::Remote::unlink(bool is_input, const std::string& text) {
  const auto link = HC_TRY(internal::parse_port_link(module_, is_input, text));
  const Error unknown{Code::NotFound, "there is no such link"};
  const auto outlet = is_input ? nullptr : outlets_.abandon(link);
  if (!is_input && outlet == nullptr) return unknown;
  report_counters();  // the last of this link
  if (is_input && !inlets_.remove(link)) return unknown;
  if (!is_input) outlets_.remove(link, outlet);
  note(TraceEvent::What::Unlinked, is_input, link);
  report_links();
  return {};
}

void Module::Remote::note(TraceEvent::What what, bool is_input,
                          const internal::PortLink& link) const {
  if (!is_input && !link.is_trace)
    module_.loop_->trace.note_link(what, *module_.outputs_[link.port], link.uri.text());
}

void Module::Remote::send(Report report, Message message) {
  module_.management_->send(report, std::move(message), module_.clock_.wall());
}

void Module::Remote::report_counters() {
  reported_ = now_.machine;
  now_.read_wall();
  std::vector<LinkCounters> rows;
  inlets_.add_counters(rows);
  outlets_.add_counters(rows);
  send(Report::Counters, make_counters(rows));
}

void Module::Remote::report_links() {
  std::vector<LinkEnd> rows;
  inlets_.add_ends(rows);
  outlets_.add_ends(rows);
  send(Report::Links, make_links(rows));
}

void Module::Remote::report_parameters() {
  std::map<std::string, std::string> values;
  for (const auto& parameter : module_.parameters_)
    values[parameter->name] = text(parameter->value);
  send(Report::Parameters, make_parameters(values));
}

void Module::Remote::report_state(const internal::Outlet* blocked) {
  // With its first report a module counts as running, and its parameters must be known.
  if (reported_.count() == 0) report_parameters();
  const auto& focus = module_.focus_;
  const auto row = blocked == nullptr
                       ? 0
                       : static_cast<std::int64_t>(inlets_.size() + outlets_.index_of(blocked) + 1);
  send(Report::State, make_state({focus.own, focus.decided != 0 ? focus.decided : focus.current,
                                  focus.in_focus(), row, focus.stops}));
}

}  // namespace hc
