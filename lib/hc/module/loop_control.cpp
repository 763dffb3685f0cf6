// SPDX-License-Identifier: Apache-2.0
// A module's loop: what it is told by who runs it, and what it reports.
#include <algorithm>
#include <array>
#include <tuple>

#include <hc/module/loop.h>

namespace hc {
namespace {

using internal::LinkedSink;
using internal::LinkedSource;
using internal::Report;

/// How often a module that is busy looks for commands; one that waits is woken by them.
constexpr std::chrono::milliseconds kLookPeriod{10};

/// "PORT=URI" of a link at a port.
std::string text_of(const std::string& port, const std::string& uri) {
  return port + "=" + uri;
}

/// Numbers of a report that has one row for each link: a Traffic's, left out, ages and gaps.
constexpr std::size_t kQuantileColumns = 3;
constexpr std::size_t kColumns = std::tuple_size_v<Counters> + 1 + 2 * kQuantileColumns;

Status unknown_link() {
  return Error{Code::NotFound, "there is no such link"};
}

void add_quantiles(const internal::Quantiles& quantiles, std::vector<std::int64_t>& row) {
  const bool none = quantiles.empty();
  for (double part : {0.5, 0.99}) row.push_back(none ? -1 : quantiles.quantile(part));
  row.push_back(none ? -1 : quantiles.most());
}

}  // namespace

/// Hears which mode has the focus and, from time to time, what the module is to do; and reports.
void Module::Loop::attend() {
  hear_focus();
  if (now_ - attended_ < kLookPeriod) return;
  attended_ = now_;
  for (const auto& command : management_.take_commands()) obey(command);
  report();
}

void Module::Loop::hear_focus() {
  if (module_.message_time_) return;  // in its time
  Message message;
  for (auto& link : focus_) {
    while (link.source != nullptr) {
      auto got = link.source->take(message);
      if (got && *got == Got::Nothing) break;
      if (!got || *got == Got::End)
        link.source.reset();  // the module goes on in the mode it knows
      else
        heed(message);
    }
  }
}

void Module::Loop::heed(const Message& focus) {
  const bool was_idle = module_.attention_.is_idle();
  const auto before = module_.attention_.focus;
  if (auto modes = focus.view<std::int32_t>(); modes && !modes->empty())
    module_.attention_.focus = modes->at(0, 0);
  if (was_idle && !module_.attention_.is_idle())
    for (auto& input : module_.inputs_) input->handled_at.reset();
  if (module_.attention_.focus != before) tell_state();
}

void Module::Loop::obey(const std::string& command) {
  if (command.empty()) return;
  auto done = carry_out(command);
  if (done) return;
  const std::string line = "command \"" + command + "\": " + done.error().detail;
  if (management_.is_heard())
    management_.tell(Report::Refusal, std::array{line}, module_.clock_.wall());
  else
    module_.log(line);
}

Status Module::Loop::carry_out(const std::string& command) {
  auto verb = command.substr(0, command.find(' '));
  auto rest = command.substr(std::min(command.size(), verb.size() + 1));
  if (verb == "set") return set_parameter(rest);
  if (verb == "finish") return finish(rest);
  if (verb == "route") {
    auto route = internal::parse_link_route(rest);
    if (!route) return route.error();
    set_route(route->first, route->second);
    return {};
  }
  const bool is_input = rest.starts_with("in ");
  if ((verb == "link" || verb == "unlink") && (is_input || rest.starts_with("out "))) {
    auto text = rest.substr(rest.find(' ') + 1);
    auto done = verb == "link" ? link(is_input, text) : unlink(is_input, text);
    if (done) tell_links();
    return done;
  }
  return Error{Code::Invalid,
               "a command is set NAME=VALUE, link or unlink in|out PORT=URI, finish PORT=URI, "
               "route PORT=URI WORDS"};
}

Status Module::Loop::set_parameter(const std::string& assignment) {
  auto name = assignment.substr(0, assignment.find('='));
  for (auto& parameter : module_.parameters_) {
    if (parameter->name != name || name.size() == assignment.size()) continue;
    if (parameter->options.fixed)
      return Error{Code::Invalid, "parameter " + name + " is fixed while the module runs"};
    auto set = parameter->set(assignment.substr(name.size() + 1));
    if (set) tell_parameters();
    return set;
  }
  return Error{Code::Invalid, "no parameter \"" + name + "\", or no value"};
}

Status Module::Loop::link(bool is_input, const std::string& text) {
  auto link = internal::parse_port_link(module_, is_input, text);
  if (!link) return link.error();
  // What cannot be opened is told, and leaves the module as it was.
  try {
    if (link->is_focus) {
      auto source = open_source(link->uri, options_);
      if (!source) return source.error();
      const auto uri = link->uri.text();
      std::erase_if(focus_, [&](const auto& each) { return each.uri == uri; });
      focus_.push_back({uri, std::move(*source), {}});
      module_.attention_.is_told = true;
    } else if (is_input) {
      open_input(link->uri, {module_.inputs_[link->port].get()});
    } else {
      module_.outputs_[link->port]->links.push_back(open_output(link->uri));
    }
  } catch (const ModuleError& error) {
    return Error{Code::System, error.what()};
  }
  return {};
}

Status Module::Loop::unlink(bool is_input, const std::string& text) {
  auto link = internal::parse_port_link(module_, is_input, text);
  if (!link) return link.error();
  auto uri = link->uri.text();
  if (!is_input) return unlink_output(*module_.outputs_[link->port], uri);
  tell_counters();  // the last of this link
  if (link->is_focus) {
    const auto erased = std::erase_if(focus_, [&](const auto& each) { return each.uri == uri; });
    return erased == 0 ? unknown_link() : Status();
  }
  auto* input = module_.inputs_[link->port].get();
  // What is taken together with this input waits for the next link, and is not ended.
  const auto erased = std::erase_if(sources_, [&](const LinkedSource& each) {
    return each.uri == uri && each.inputs.front() == input;
  });
  return erased == 0 ? unknown_link() : Status();
}

Status Module::Loop::unlink_output(internal::OutputState& output, const std::string& uri) {
  auto& links = output.links;
  auto found =
      std::find_if(links.begin(), links.end(), [&](const auto& each) { return each->uri == uri; });
  if (found == links.end()) return unknown_link();
  // Closing would wait for who is slow; nobody is to have these messages any more.
  if (auto* sink = (*found)->sink.get()) {
    const auto before = sink->traffic().cut;
    sink->abandon();
    if (const auto lost = sink->traffic().cut - before; lost > 0)
      module_.log(output.name + ": " + std::to_string(lost) + " waiting, lost with the link");
  }
  tell_counters();  // the last of this link
  sinks_.erase(std::find(sinks_.begin(), sinks_.end(), *found));
  links.erase(found);
  return {};
}

Status Module::Loop::finish(const std::string& text) {
  auto link = internal::parse_port_link(module_, true, text);
  if (!link) return link.error();
  for (auto& each : sources_)
    if (each.uri == link->uri.text() && each.source != nullptr) each.source->finish();
  for (auto& each : focus_)
    if (link->is_focus && each.uri == link->uri.text() && each.source != nullptr)
      each.source->finish();
  return {};
}

/// Gives a link that there is, "PORT=URI", its route.
void Module::Loop::set_route(const std::string& link, const internal::Route& route) {
  for (auto& each : sources_)
    for (const auto* input : each.inputs)
      if (text_of(input->name, each.uri) == link) each.route = route;
  for (const auto& output : module_.outputs_)
    for (auto& each : output->links)
      if (text_of(output->name, each->uri) == link) each->route = route;
}

void Module::Loop::report() {
  if (!management_.is_heard() || now_ - reported_ < kReportPeriod) return;
  if (reported_.count() == 0) {
    tell_links();
    tell_parameters();
    tell_state();
  }
  tell_counters();
}

void Module::Loop::tell_counters() {
  reported_ = now_;
  to_wall_ = module_.clock_.wall() - module_.clock_.monotonic().count();
  std::vector<std::int64_t> numbers;
  auto put = [&](const Traffic& traffic) {
    auto counters = counters_of(traffic);
    numbers.insert(numbers.end(), counters.begin(), counters.end());
  };
  for (auto& link : sources_) {
    put(link.traffic());
    auto left_out = link.left_out;
    for (const auto& together : module_.together_)
      if (link.inputs.front()->matcher == &together->matcher) left_out += together->left_out;
    numbers.push_back(left_out);
    add_quantiles(link.ages, numbers);
    add_quantiles(link.gaps, numbers);
    link.ages.clear();
    link.gaps.clear();
  }
  for (const auto& link : sinks_) {
    put(link->sink ? link->sink->traffic() : link->traffic);
    numbers.push_back(0);
    numbers.insert(numbers.end(), 2 * kQuantileColumns, -1);
  }
  // Also where there is no row: that we report tells that we are not stuck.
  management_.tell(Report::Counters, numbers, kColumns, module_.clock_.wall());
}

void Module::Loop::tell_links() {
  std::vector<std::string> lines;
  for (const auto& link : sources_)
    lines.push_back("in " + (link.inputs.size() == 1 ? link.inputs[0]->name : "-") + " " +
                    link.uri);
  for (const auto& sink : sinks_)
    for (const auto& output : module_.outputs_)
      if (std::find(output->links.begin(), output->links.end(), sink) != output->links.end()) {
        lines.push_back("out " + output->name + " " + sink->uri);
        break;  // standard output may be of several ports
      }
  management_.tell(Report::Links, lines, module_.clock_.wall());
}

void Module::Loop::tell_parameters() {
  std::vector<std::string> lines;
  for (const auto& parameter : module_.parameters_)
    lines.push_back(parameter->name + "=" + text(parameter->value));
  management_.tell(Report::Parameters, lines, module_.clock_.wall());
}

void Module::Loop::tell_state(bool awaits_reader) {
  const auto& attention = module_.attention_;
  const std::int64_t state[] = {attention.own, attention.focus, attention.in_focus() ? 1 : 0,
                                awaits_reader ? 1 : 0};
  management_.tell(Report::State, state, std::size(state), module_.clock_.wall());
}

}  // namespace hc
