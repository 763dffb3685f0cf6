// SPDX-License-Identifier: Apache-2.0
#include <hc/module/loop.h>

#include <poll.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include <hc/compress/compress.h>
#include <hc/os/program.h>

namespace hc {
namespace {

using internal::fail;
using internal::Inlet;
using internal::Outlet;
using internal::Stopped;

constexpr const char* kReportsKept = "64";  // for one who does not listen for a while
constexpr const char* kSetsKept = "4";      // by links whose newest complete set is handled
constexpr int kMostAtOnce = 16;             // messages that a link gives in one turn

/// Whether a link has keep=latest, which makes place for a short queue.
bool keeps_latest(Uri& uri) {
  for (auto& [key, value] : uri.options)
    if (key == "keep" && (value == "latest" || value == "1")) {
      value = kSetsKept;
      return true;
    }
  return false;
}

}  // namespace

Module::Loop::Loop(Module& module, const internal::Arguments& arguments, int stop)
    : module_(module),
      now_{module.clock_, module.message_time_},
      trace_(module.clock_),
      timers_(module, now_, trace_),
      opener_(module, {.limits = arguments.limits, .log = {}, .stop = stop}),
      management_(*(module.management_ = std::make_shared<internal::Management>())),
      outlets_(module, trace_, opener_,
               {[this](const Outlet* blocked) { report_state(blocked); },
                [this] { return obey_while_sending(); }}),
      waits_(stop),
      pauses_(stop) {
  module_.focus_ = arguments.focus;
  // What the process before has reported counts until this one knows better.
  for (const auto& parameter : module_.parameters_)
    if (parameter->name == kStops)
      module_.focus_.stops = value_or_end(parse_stops(text(parameter->value)));
  if (arguments.wall_offset)
    internal::distant_wall.set(*arguments.wall_offset, module_.clock_.monotonic());
  std::unique_ptr<Sink> reports;
  if (arguments.manage) {
    Uri uri = *arguments.manage;
    if (uri.option("keep", "").empty()) uri.options.emplace_back("keep", kReportsKept);
    auto sink = open_sink(uri);  // it outlives this loop
    if (!sink) fail(uri.text(), sink.error());
    reports = std::move(*sink);
  }
  management_.open(std::move(reports),
                   arguments.control ? opener_.open(*arguments.control, "commands") : nullptr);
  outlets_.open(arguments);
  open_inputs(arguments);
  for (const auto& link : arguments.inputs)
    if (link.is_focus) open_focus(link.uri);
  for (const auto& [link, route] : arguments.routes) set_route(link, route);
  if (arguments.clock) read_moments(*arguments.clock);
  module_.loop_ = this;
}

Module::Loop::~Loop() {
  if (!stop_requested()) opener_.log_lines(MonotonicTime::max());
  module_.loop_ = nullptr;
}

void Module::Loop::open_focus(const Uri& uri) {
  focus_.push_back({.uri = uri.text(), .source = opener_.open(uri, "focus")});
  module_.focus_.is_linked = true;
}

void Module::Loop::open_input(const Uri& uri, std::vector<internal::InputState*> inputs) {
  // What is taken together is dropped together: by the loop, and not by each link for itself.
  Uri opened = uri;
  const bool is_latest = inputs.front()->together != nullptr && keeps_latest(opened);
  Inlet inlet{.uri = uri.text(), .source = opener_.open(opened, inputs.front()->name)};
  inlet.inputs = std::move(inputs);
  inlet.is_latest = is_latest;
  for (auto* input : inlet.inputs)
    if (input->together != nullptr) input->together->matcher.begin(input->place);
  for (const auto& each : inlets_) {
    if (each.is_same(inlet)) inlet.route = each.route;
    if (each.inputs == inlet.inputs) ++inlet.number;
  }
  inlets_.push_back(std::move(inlet));
  join_renewed();
  choose_policies();
}

/// Whether inputs that are taken together handle every set, or the newest.
void Module::Loop::choose_policies() {
  for (auto& together : module_.together_)
    together->is_latest = std::any_of(inlets_.begin(), inlets_.end(), [&](const auto& inlet) {
      return inlet.is_latest && inlet.inputs.front()->together == together.get();
    });
}

/// Has links that were opened again count on from those that ended before them; whether there are
/// any.
bool Module::Loop::join_renewed() {
  bool any = false;
  for (auto inlet = inlets_.begin(); inlet != inlets_.end();) {
    auto renewed = inlet->source != nullptr
                       ? inlets_.end()
                       : std::find_if(inlet + 1, inlets_.end(),
                                      [&](const auto& each) { return each.is_same(*inlet); });
    if (renewed == inlets_.end()) {
      ++inlet;
      continue;
    }
    renewed->past += inlet->past;
    renewed->ignored += inlet->ignored;
    renewed->bad += inlet->bad;
    renewed->number = inlet->number;
    inlet = inlets_.erase(inlet);
    any = true;
  }
  return any;
}

void Module::Loop::open_inputs(const internal::Arguments& arguments) {
  for (const auto& link : arguments.inputs)
    if (!link.is_focus) open_input(link.uri, {module_.inputs_[link.port].get()});
  if (!std::ranges::all_of(arguments.inputs, &internal::PortLink::is_focus) ||
      module_.inputs_.empty() || arguments.control)
    return;
  std::vector<internal::InputState*> all;
  for (auto& input : module_.inputs_) all.push_back(input.get());
  open_input({"-", "", {}}, std::move(all));
}

void Module::Loop::run() {
  end_unlinked();
  end_unneeded();
  now_.read();
  attend();
  if (module_.message_time_) begin_clock();
  timers_.start();
  if (module_.start_) module_.start_();
  for (bool is_now = false; true;) {
    if (stop_requested()) throw Stopped();
    // What was waited for comes first.
    if (!std::exchange(is_now, false)) now_.read();
    if (moments_) {
      if (!repeat_next()) break;
      serve();
      continue;
    }
    receive_focus();
    const bool any = module_.message_time_ ? take_earliest() : take_each();
    end_unneeded();
    if (join_renewed()) report_links();
    serve();
    timers_.fire_due();
    read_watched();
    if (any) continue;
    if (is_generators_turn()) {
      trace_.note(TraceEvent::What::Began, TraceEvent::kGenerator);
      const bool goes_on = generate();
      trace_.note(TraceEvent::What::Ended, TraceEvent::kGenerator);
      if (!goes_on) break;
    } else if (all_ended()) {
      break;
    } else {
      is_now = wait(true, timers_.next());
    }
  }
  for (const auto& together : module_.together_)
    for (const auto& input : together->inputs) together->matcher.end(input->place);
  module_.handled_ = {};
  if (module_.end_) module_.end_();
}

/// Module::finish_when_stopped().
void Module::Loop::take_rest() {
  constexpr std::chrono::milliseconds kSilence{200}, kLongest{2000};
  constexpr int kPause = 5;  // [ms]
  const auto begin = module_.clock_.monotonic();
  for (auto last = begin;
       now_.machine - last < kSilence && now_.machine - begin < kLongest && !all_ended();) {
    now_.read();
    if (take_each())
      last = now_.machine;
    else
      ::poll(nullptr, 0, kPause);
  }
  module_.handled_ = {};
  if (module_.end_) module_.end_();
}

/// Whether nothing can come any more. A module that takes commands waits for a new link
/// where an input has none; one without inputs has its timers.
bool Module::Loop::all_ended() const {
  if (module_.keeps_running_ && !module_.message_time_) return false;
  if (inlets_.empty() &&
      (management_.commands() != nullptr || (module_.inputs_.empty() && !module_.timers_.empty())))
    return false;
  return std::all_of(inlets_.begin(), inlets_.end(),
                     [](const Inlet& inlet) { return inlet.source == nullptr; });
}

/// Calls the handlers of the module's own descriptors that are readable.
void Module::Loop::read_watched() {
  for (auto& watch : module_.watches_) {
    pollfd watched{watch.descriptor(), POLLIN, 0};
    if (watched.fd < 0 || ::poll(&watched, 1, 0) <= 0) continue;
    watch.handler();
    now_.read();
  }
}

/// Takes a message from each link, but from those with too many that wait for others' only when
/// nothing else has any.
bool Module::Loop::take_each() {
  auto is_crowded = [](const Inlet& inlet) {
    return std::any_of(inlet.inputs.begin(), inlet.inputs.end(), [](const auto* input) {
      return input->together != nullptr && input->together->matcher.crowded(input->place);
    });
  };
  bool any = false;
  for (bool crowded : {false, true}) {
    for (auto& inlet : inlets_) {
      // For the newest set all that has come is taken; for every set, one message.
      const auto* together = inlet.inputs.front()->together;
      const int most = together != nullptr && together->is_latest ? kMostAtOnce : 1;
      for (int i = 0; i < most; ++i) {
        if (inlet.source == nullptr || is_crowded(inlet) != crowded) break;
        if (any) now_.read();  // the messages before have taken their time
        if (!take_one(inlet)) break;
        any = true;
      }
    }
    if (any) break;
  }
  handle_newest();
  return any;
}

void Module::Loop::handle_newest() {
  for (auto& together : module_.together_) {
    if (together->set.empty()) continue;
    const auto inlet = std::ranges::find_if(
        inlets_, [&](const auto& each) { return each.inputs.front()->together == together.get(); });
    if (inlet == inlets_.end()) continue;  // it was unlinked
    drop_bad(*inlet, inlet->inputs.front()->name, [&] { module_.handle(*together); });
  }
}

bool Module::Loop::take_one(Inlet& inlet) {
  Message message;
  if (take(inlet, message) != Got::Message) return false;
  const auto come = now_.machine;
  const auto sensed = message.header.time;  // a handler may move the message away
  handle(inlet, message);
  if (management_.is_heard()) measure(inlet, sensed, come);  // what is sent does not wait for it
  return true;
}

void Module::Loop::handle(Inlet& inlet, Message& message) {
  if (inlet.inputs.empty())
    set_focus(inlet, message);
  else
    deliver(inlet, message);
}

/// What a link has now; one that has ended is ended here too.
Got Module::Loop::take(Inlet& inlet, Message& message) {
  auto got = inlet.source->take(message);
  if (!got && inlet.inputs.empty()) got = Got::End;  // the focus expires
  if (!got) {
    bool is_of_link = got.error().code == Code::NotFound || got.error().code == Code::Closed;
    const std::string& port = inlet.inputs[0]->name;
    fail(is_of_link || inlet.inputs.size() > 1 ? opener_.name_of(inlet.uri, port) : port,
         got.error());
  }
  if (*got == Got::End) end(inlet);
  return *got;
}

bool Module::Loop::is_linked(const internal::InputState& input) const {
  return std::any_of(inlets_.begin(), inlets_.end(), [&](const Inlet& inlet) {
    return inlet.source != nullptr &&
           std::find(inlet.inputs.begin(), inlet.inputs.end(), &input) != inlet.inputs.end();
  });
}

void Module::Loop::end(Inlet& inlet) {
  inlet.past += inlet.source->traffic();
  inlet.source.reset();
  inlet.head.reset();
  for (auto* input : inlet.inputs)
    if (input->together != nullptr && !is_linked(*input))
      input->together->matcher.end(input->place);
}

/// Ends inputs that are taken together and have no link, and cannot get one by a command.
void Module::Loop::end_unlinked() {
  const bool is_controlled = management_.commands() != nullptr;
  for (const auto& together : module_.together_) {
    std::string unlinked;
    for (const auto& input : together->inputs) {
      if (is_linked(*input)) continue;
      unlinked = input->name;
      if (!is_controlled) together->matcher.end(input->place);
    }
    for (const auto& input : together->inputs)
      if (!unlinked.empty() && is_linked(*input))
        module_.log(input->name + (is_controlled ? ": waits as long as " : ": not read, since ") +
                    unlinked + " has no link");
  }
}

/// Ends the links whose messages can have no partners any more.
void Module::Loop::end_unneeded() {
  if (module_.together_.empty()) return;
  auto is_settled = [](const auto* input) {
    return input->together != nullptr && input->together->matcher.done();
  };
  for (auto& inlet : inlets_)
    if (inlet.source != nullptr &&
        std::all_of(inlet.inputs.begin(), inlet.inputs.end(), is_settled))
      end(inlet);
}

void Module::Loop::log_dropped() {
  for (const auto& together : module_.together_)
    for (const auto& input : together->inputs) {
      const auto& dropped = together->matcher.dropped(input->place);
      if (dropped.total() == 0 || together->is_latest) continue;
      module_.log(input->name + ": dropped " + std::to_string(dropped.unmatched) + " unmatched, " +
                  std::to_string(dropped.crowded) + " on queue overflow");
    }
}

void Module::Loop::deliver(Inlet& inlet, Message& message) {
  for (auto* input : inlet.inputs) {
    const bool fits_any =
        input->types.empty() ||
        std::any_of(input->types.begin(), input->types.end(),
                    [&](const PortType& type) { return fits(message.header, type); });
    if (!fits_any) continue;
    trace_.note(TraceEvent::What::Took, input->name, message.header, inlet.number);
    if (!input->handler) return;
    if (!module_.focus_.admits(input->is_exclusive, message.header.mode)) {
      ++inlet.ignored;
      return;
    }
    if (input->is_raw || message.plain()) return call(*input, inlet, message);
    auto plain = expand(message);
    if (!plain) return drop(inlet, input->name, plain.error().text());
    return call(*input, inlet, *plain);
  }
  const bool is_one = inlet.inputs.size() == 1;
  drop(inlet, is_one ? inlet.inputs.front()->name : inlet.uri, misfit_of(inlet, message).text());
}

/// Drops a message; it was handed over, so that its link goes on. The first is logged.
void Module::Loop::drop(Inlet& inlet, const std::string& who, std::string_view why) {
  ++inlet.bad;
  has_failed_input_ = has_failed_input_ || inlet.is_file();
  module_.log_once("bad at " + who,
                   who + ": dropped: " + std::string(why.substr(0, why.find('\n'))));
}

/// Why a message fits no input of its link.
Error Module::Loop::misfit_of(const Inlet& inlet, const Message& message) {
  const auto& only = *inlet.inputs.back();
  if (inlet.inputs.size() == 1 && only.types.size() == 1)
    return misfit(message.header, only.types[0]);
  std::string takers;
  for (const auto* input : inlet.inputs)
    takers += (takers.empty() ? "" : ", ") + input->name + " takes " + in_words(input->types);
  const Header& header = message.header;
  std::string what = matrix_text(header.info, header.width, header.height);
  if (header.coord != 0) what += " in coordinate system " + coord_and_number(header.coord);
  return {Code::Malformed, what + " fits no input: " + takers};
}

void Module::Loop::call(const internal::InputState& input, Inlet& inlet, Message& message) {
  if (input.is_finite && !finite(message)) {
    ++inlet.ignored;
    return module_.log_once("not finite", input.name + ": dropped: NaN or infinity");
  }
  module_.handled_ = internal::Handled(message.header, &inlet.route.peer);
  drop_bad(inlet, input.name, [&] {
    if (!trace_.is_linked() || input.together != nullptr) [[likely]]
      return input.handler(message);
    const Header header = message.header;  // a handler may move the message away
    trace_.note(TraceEvent::What::Began, input.name, header, inlet.number);
    input.handler(message);
    trace_.note(TraceEvent::What::Ended, input.name, header, inlet.number);
  });
  module_.handled_ = {};
}

/// Notes how old a message is, and how long after the one before it came.
void Module::Loop::measure(Inlet& inlet, std::int64_t sensed, MonotonicTime come) {
  if (sensed != 0) inlet.ages.add(come.count() + now_.wall_offset - sensed);
  if (inlet.last_come.count() != 0) inlet.gaps.add((come - inlet.last_come).count());
  inlet.last_come = come;
}

/// Waits for a command, a report that is due, or a time; and, perhaps, for messages and what else
/// the module reads. Whether it was so short that now_.machine is the time still.
bool Module::Loop::wait(bool for_messages, MonotonicTime until) {
  waited_for_.clear();
  watched_.clear();
  if (for_messages) {
    for (const auto& inlet : inlets_)
      if (inlet.source != nullptr && !inlet.head) waited_for_.push_back(inlet.source.get());
    for (const auto& watch : module_.watches_) watched_.push_back(watch.descriptor());
  }
  for (const auto& link : focus_)
    if (link.source != nullptr && !link.head) waited_for_.push_back(link.source.get());
  if (management_.commands() != nullptr) waited_for_.push_back(management_.commands());
  if (module_.message_time_) until = MonotonicTime::max();  // it is messages that pass the time
  if (management_.is_heard()) until = std::min(until, reported_ + kReportPeriod);
  until = std::min(until, opener_.due());
  auto timeout = std::chrono::nanoseconds(-1);
  if (until != MonotonicTime::max())
    timeout = std::max(until - now_.machine, std::chrono::nanoseconds(0));
  auto& waits = for_messages ? waits_ : pauses_;
  if (module_.before_waiting_) module_.before_waiting_();
  auto ready = waits.wait(waited_for_, watched_, timeout);
  if (!ready) fail("wait", ready.error());
  if (management_.commands() != nullptr && waits.was_woken_by(*management_.commands()))
    attended_ = {};
  return waits.was_short();
}

void Module::Loop::pause(const std::function<MonotonicTime()>& due) {
  if (module_.message_time_) {
    has_generated_ = false;
    while (moments_ && !moments_->empty() && moments_->front().port == internal::kFocusPort)
      repeat_next();
    return now_.pass_to(std::max(now_.time(), due()));
  }
  for (now_.read(); now_.machine < due(); now_.read()) {
    wait(false, due());
    now_.read();
    attend();
  }
}

void Module::Loop::close() {
  if (module_.before_waiting_) module_.before_waiting_();
  log_dropped();
  trace_.flush();
  const auto closed = outlets_.close();
  report_counters();
  if (!closed) fail(closed.error());
}

}  // namespace hc
