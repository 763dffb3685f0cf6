// SPDX-License-Identifier: Apache-2.0
#include <hc/node/loop.h>

#include <algorithm>
#include <tuple>

#include <hc/base/program.h>
#include <hc/compress/compress.h>

namespace hc {
namespace {

using internal::LinkedSink;
using internal::LinkedSource;
using internal::Stopped;

constexpr std::chrono::seconds kReportPeriod{1};

/// What ends a module: cleanly when it was told to stop, else with the name of who failed.
[[noreturn]] void fail(const std::string& who, const Error& error) {
  if (error.code == Code::Stopped) throw Stopped();
  throw ModuleError(Error{error.code, who + ": " + error.detail});
}

}  // namespace

Module::Loop::Loop(Module& module, const internal::Arguments& arguments, int stop)
    : module_(module) {
  options_.limits = arguments.limits;
  options_.stop = stop;
  options_.log = [this](Severity, std::string_view line) { module_.log(line); };
  open_outputs(arguments);
  if (arguments.manage) {
    auto sink = open_sink(*arguments.manage, options_);
    if (!sink) fail(arguments.manage->text(), sink.error());
    manage_ = std::move(*sink);
  }
  open_inputs(arguments);
}

void Module::Loop::open_outputs(const internal::Arguments& arguments) {
  auto open = [&](const Uri& uri) {
    auto sink = open_sink(uri, options_);
    if (!sink) fail(uri.text(), sink.error());
    auto link = std::make_shared<LinkedSink>();
    link->uri = uri.text();
    link->sink = std::move(*sink);
    sinks_.push_back(link);
    return link;
  };
  for (const auto& [port, uri] : arguments.outputs)
    module_.outputs_[port]->links.push_back(open(uri));
  if (!arguments.outputs.empty() || module_.outputs_.empty()) return;
  auto standard_output = open({"-", "", {}});
  for (auto& output : module_.outputs_) output->links.push_back(standard_output);
}

void Module::Loop::open_inputs(const internal::Arguments& arguments) {
  auto open = [&](const Uri& uri, std::vector<internal::InputState*> inputs) {
    auto source = open_source(uri, options_);
    if (!source) fail(uri.text(), source.error());
    sources_.push_back({uri.text(), std::move(*source), std::move(inputs), {}});
  };
  for (const auto& [port, uri] : arguments.inputs) open(uri, {module_.inputs_[port].get()});
  if (!arguments.inputs.empty() || module_.inputs_.empty()) return;
  std::vector<internal::InputState*> all;
  for (auto& input : module_.inputs_) all.push_back(input.get());
  open({"-", "", {}}, std::move(all));
}

void Module::Loop::run() {
  end_unlinked();
  end_unneeded();
  if (module_.start_) module_.start_();
  auto has_ended = [](const LinkedSource& link) { return link.source == nullptr; };
  while (true) {
    if (stop_requested()) throw Stopped();
    const bool any = take_each();
    end_unneeded();
    report();
    if (any) continue;
    if (module_.generate_) {
      if (!module_.generate_()) break;
    } else if (std::all_of(sources_.begin(), sources_.end(), has_ended)) {
      break;
    } else {
      wait();
    }
  }
  for (const auto& together : module_.together_)
    for (const auto& input : together->inputs) together->matcher.end(input->place);
  module_.handled_time_ = 0;
  if (module_.end_) module_.end_();
}

/// Takes a message from each link, but from those with too many that wait for others' only when
/// nothing else has any.
bool Module::Loop::take_each() {
  auto is_crowded = [](const LinkedSource& link) {
    return std::any_of(link.inputs.begin(), link.inputs.end(), [](const auto* input) {
      return input->matcher != nullptr && input->matcher->crowded(input->place);
    });
  };
  bool any = false;
  for (bool crowded : {false, true}) {
    for (auto& link : sources_)
      if (link.source != nullptr && is_crowded(link) == crowded) any = take_one(link) || any;
    if (any) break;
  }
  return any;
}

bool Module::Loop::take_one(LinkedSource& link) {
  Message message;
  auto got = link.source->take(message);
  if (!got) {
    bool is_of_link = got.error().code == Code::NotFound || got.error().code == Code::Closed;
    fail(is_of_link || link.inputs.size() > 1 ? link.uri : link.inputs[0]->name, got.error());
  }
  if (*got == Got::End) end(link);
  if (*got != Got::Message) return false;
  deliver(link, message);
  return true;
}

bool Module::Loop::is_linked(const internal::InputState& input) const {
  return std::any_of(sources_.begin(), sources_.end(), [&](const LinkedSource& link) {
    return link.source != nullptr &&
           std::find(link.inputs.begin(), link.inputs.end(), &input) != link.inputs.end();
  });
}

void Module::Loop::end(LinkedSource& link) {
  link.traffic = link.source->traffic();
  link.source.reset();
  for (auto* input : link.inputs)
    if (input->matcher != nullptr && !is_linked(*input)) input->matcher->end(input->place);
}

void Module::Loop::end_unlinked() {
  for (const auto& together : module_.together_) {
    std::string unlinked;
    for (const auto& input : together->inputs) {
      if (is_linked(*input)) continue;
      unlinked = input->name;
      together->matcher.end(input->place);
    }
    for (const auto& input : together->inputs)
      if (!unlinked.empty() && is_linked(*input))
        module_.log(input->name + ": not read, since " + unlinked + " has no link");
  }
}

/// Ends the links whose messages can have no partners any more.
void Module::Loop::end_unneeded() {
  if (module_.together_.empty()) return;
  auto is_settled = [](const auto* input) {
    return input->matcher != nullptr && input->matcher->done();
  };
  for (auto& link : sources_)
    if (link.source != nullptr && std::all_of(link.inputs.begin(), link.inputs.end(), is_settled))
      end(link);
}

void Module::Loop::tell_left_out() {
  for (const auto& together : module_.together_)
    for (const auto& input : together->inputs) {
      const auto& left_out = together->matcher.left_out(input->place);
      if (left_out.total() == 0) continue;
      module_.log(input->name + ": left out: " + std::to_string(left_out.unmatched) +
                  " unmatched, " + std::to_string(left_out.crowded) + " crowded out");
    }
}

void Module::Loop::deliver(LinkedSource& link, const Message& message) {
  std::string takers;
  for (auto* input : link.inputs) {
    auto fits_message = [&](const PortType& type) {
      return fits(message.header, type).has_value();
    };
    if (!input->types.empty() &&
        std::none_of(input->types.begin(), input->types.end(), fits_message)) {
      takers += (takers.empty() ? "" : ", ") + input->name + " takes " + in_words(input->types);
      continue;
    }
    if (!input->handler) return;
    module_.handled_time_ = message.header.time;
    module_.handled_mode_ = message.header.mode;
    auto plain = expand(message);
    if (!plain) fail(input->name, plain.error());
    input->handler(*plain);
    module_.handled_time_ = 0;
    return;
  }
  const auto& only = *link.inputs.back();
  if (link.inputs.size() == 1 && only.types.size() == 1)
    fail(only.name, fits(message.header, only.types[0]).error());
  std::string what = text(message.header.info);
  if (message.header.coord != 0)
    what += ", coordinate system " + std::to_string(message.header.coord);
  fail(link.uri, Error{Code::Malformed, what + " fits no input: " + takers});
}

void Module::Loop::wait() {
  std::vector<Source*> sources;
  for (const auto& link : sources_)
    if (link.source != nullptr) sources.push_back(link.source.get());
  auto timeout = manage_ ? std::chrono::milliseconds(kReportPeriod) : std::chrono::milliseconds(-1);
  auto ready = wait_any(sources, options_.stop, timeout);
  if (!ready) fail("poll", ready.error());
}

void Module::Loop::report() {
  if (manage_ == nullptr || module_.clock_.monotonic() - reported_ < kReportPeriod) return;
  reported_ = module_.clock_.monotonic();
  auto links = sources_.size() + sinks_.size();
  Draft draft = Draft::make(table<std::int64_t>(std::tuple_size_v<Counters>).type.info, 1,
                            static_cast<std::int32_t>(links));
  auto rows = draft.view<std::int64_t>();
  std::size_t row = 0;
  auto put = [&](const Traffic& traffic) {
    auto counters = counters_of(traffic);
    std::copy(counters.begin(), counters.end(), rows.row(row++).begin());
  };
  for (const auto& link : sources_) put(link.source ? link.source->traffic() : link.traffic);
  for (const auto& link : sinks_) put(link->sink ? link->sink->traffic() : link->traffic);
  draft.header.seq = reports_++;
  draft.header.time = module_.now();
  // Who does not listen to our counters does not stop our work.
  if (!manage_->send(std::move(draft).finish())) manage_.reset();
}

void Module::Loop::close() {
  tell_left_out();
  const LinkedSink* failed = nullptr;
  Status failure;  // the first; the other links are closed all the same
  for (auto& link : sinks_) {
    if (link->sink == nullptr) continue;
    auto closed = link->sink->close();
    link->traffic = link->sink->traffic();
    if (closed || closed.error().code == Code::Closed || failed != nullptr) continue;
    failed = link.get();
    failure = closed;
  }
  reported_ = MonotonicTime(0);
  report();
  if (failed != nullptr) fail(failed->uri, failure.error());
}

}  // namespace hc
