// SPDX-License-Identifier: Apache-2.0
#include <hc/module/loop.h>

#include <poll.h>

#include <algorithm>
#include <utility>

#include <hc/os/program.h>

namespace hc {
namespace {

using internal::fail;
using internal::Inlet;
using internal::Stopped;

/// How often a busy module looks for commands; one that waits is woken by them.
constexpr std::chrono::milliseconds kHousekeepingPeriod{10};
}  // namespace

Module::Loop::Loop(Module& module, const internal::Arguments& arguments, int stop)
    : module_(module),
      now_{module.clock_, module.message_time_},
      trace_(module.clock_),
      timers_(module, now_, trace_),
      opener_(module, {.limits = arguments.limits, .log = {}, .stop = stop}),
      delivery_(module, now_, trace_, [this] { remote_.report_state(); }),
      inlets_(module, now_, opener_, delivery_),
      outlets_(module, trace_, opener_,
               {[this](const internal::Outlet* blocked) { remote_.report_state(blocked); },
                [this] { return remote_.obey_while_sending(); }}),
      remote_(module, now_, opener_, inlets_, outlets_),
      waits_(stop),
      pauses_(stop) {
  module_.management_ = std::make_shared<internal::Management>();
  module_.focus_ = arguments.focus;
  // What the process before has reported counts until this one knows better.
  for (const auto& parameter : module_.parameters_)
    if (parameter->name == kStops)
      module_.focus_.stops = value_or_end(parse_stops(text(parameter->value)));
  if (arguments.wall_offset)
    internal::distant_wall.set(*arguments.wall_offset, module_.clock_.monotonic());
  remote_.open(arguments);
  outlets_.open(arguments);
  inlets_.open(arguments);
  for (const auto& [link, route] : arguments.routes) {
    inlets_.set_route(link, route);
    outlets_.set_route(link, route);
  }
  if (arguments.clock) read_moments(*arguments.clock);
  module_.loop_ = this;
}

Module::Loop::~Loop() {
  if (!stop_requested()) opener_.log_lines(MonotonicTime::max());
  module_.loop_ = nullptr;
}

void Module::Loop::run() {
  inlets_.sets().end_unlinked(opener_.is_in_graph());
  inlets_.end_unneeded();
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
    if (module_.message_time_)
      delivery_.expire_focus();
    else
      inlets_.receive_focus();
    const bool any = module_.message_time_ ? take_earliest() : inlets_.take_each();
    inlets_.end_unneeded();
    if (inlets_.join_renewed()) remote_.report_links();
    serve();
    timers_.fire_due();
    read_watched();
    if (any) continue;
    if (is_generators_turn()) {
      trace_.note(TraceEvent::What::Began, TraceEvent::kGenerator);
      const bool goes_on = generate();
      trace_.note(TraceEvent::What::Ended, TraceEvent::kGenerator);
      if (!goes_on) break;
    } else if ((!module_.keeps_running_ || module_.message_time_) && inlets_.all_ended()) {
      break;
    } else {
      is_now = wait(true, timers_.next());
    }
  }
  inlets_.sets().end_all();
  module_.handled_ = {};
  if (module_.end_) module_.end_();
}

/// Module::finish_when_stopped().
void Module::Loop::take_rest() {
  constexpr std::chrono::milliseconds kSilence{200}, kLongest{2000};
  constexpr int kPause = 5;  // [ms]
  const auto begin = module_.clock_.monotonic();
  for (auto last = begin;
       now_.machine - last < kSilence && now_.machine - begin < kLongest && !inlets_.all_ended();) {
    now_.read();
    if (inlets_.take_each())
      last = now_.machine;
    else
      ::poll(nullptr, 0, kPause);
  }
  module_.handled_ = {};
  if (module_.end_) module_.end_();
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

/// Waits for a command, a report that is due, or a time; and, perhaps, for messages and what else
/// the module reads. Whether it was so short that now_.machine is the time still.
bool Module::Loop::wait(bool for_messages, MonotonicTime until) {
  waited_for_.clear();
  watched_.clear();
  inlets_.for_each([&](Inlet& inlet) {
    if (inlet.is_open() && (for_messages || inlet.inputs.empty()))
      waited_for_.push_back(inlet.source.get());
  });
  if (for_messages)
    for (const auto& watch : module_.watches_) watched_.push_back(watch.descriptor());
  if (remote_.commands() != nullptr) waited_for_.push_back(remote_.commands());
  if (module_.message_time_) until = MonotonicTime::max();  // it is messages that pass the time
  until = std::min({until, remote_.due(), opener_.due()});
  auto timeout = std::chrono::nanoseconds(-1);
  if (until != MonotonicTime::max())
    timeout = std::max(until - now_.machine, std::chrono::nanoseconds(0));
  auto& waits = for_messages ? waits_ : pauses_;
  if (module_.before_waiting_) module_.before_waiting_();
  auto ready = waits.wait(waited_for_, watched_, timeout);
  if (!ready) fail("wait", ready.error());
  if (remote_.commands() != nullptr && waits.was_woken_by(*remote_.commands())) attended_ = {};
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
  if (now_.machine - attended_ < kHousekeepingPeriod && now_.machine < remote_.due()) return;
  attended_ = now_.machine;
  if (module_.before_waiting_) module_.before_waiting_();
  // Links look for writers that have died when they are waited for, which a busy module never does.
  inlets_.for_each([](Inlet& inlet) {
    if (inlet.is_open()) inlet.source->prepare_wait();
  });
  remote_.serve();
  now_.read();  // commands may have taken their time
}

void Module::Loop::close() {
  if (module_.before_waiting_) module_.before_waiting_();
  inlets_.sets().log_dropped();
  trace_.flush();
  const auto closed = outlets_.close();
  remote_.report_counters();
  if (!closed) fail(closed.error());
}

}  // namespace hc
