// SPDX-License-Identifier: Apache-2.0
#include <hc/module/loop.h>

#include <poll.h>

#include <algorithm>
#include <utility>

#include <hc/os/program.h>

namespace hc {
namespace {

/// How often a busy module looks for commands; an idle one is woken by them.
constexpr std::chrono::milliseconds kHousekeepingPeriod{10};

/// How often a busy module polls its own descriptors.
constexpr std::chrono::milliseconds kLookPeriod{1};

}  // namespace

Module::Loop::Loop(Module& served, const internal::Arguments& arguments, int stop)
    : module(served),
      now{served.clock_, served.message_time_},
      trace(served.clock_),
      timers(served, now, trace),
      opener(served, {.limits = arguments.limits, .log = {}, .stop = stop}),
      delivery(served, now, trace, [this] { remote.report_state(); }),
      inlets(served, now, opener, delivery),
      outlets(served, trace, opener,
              {[this](const internal::Outlet* blocked) { remote.report_state(blocked); },
               [this] { return remote.obey_while_sending(); }}),
      remote(served, now, opener, inlets, outlets),
      waits_(stop),
      pauses_(stop) {
  module.management_ = std::make_shared<internal::Management>();
  module.focus_ = arguments.focus;
  // The stops that the process before this one reported are valid until it reports others.
  for (const auto& parameter : module.parameters_)
    if (parameter->name == kStops)
      module.focus_.stops = value_or_end(parse_stops(text(parameter->value)));
  if (arguments.wall_offset)
    internal::distant_wall.set(*arguments.wall_offset, module.clock_.monotonic());
  remote.open(arguments);
  outlets.open(arguments);
  inlets.open(arguments);
  for (const auto& [link, route] : arguments.routes) {
    inlets.set_route(link, route);
    outlets.set_route(link, route);
  }
  schedule_ = Schedule::make(*this, arguments.clock);
  module.loop_ = this;
}

Module::Loop::~Loop() {
  if (!stop_requested()) opener.log_lines(MonotonicTime::max());
  module.loop_ = nullptr;
}

void Module::Loop::begin() {
  inlets.sets().end_unlinked(opener.is_in_graph());
  inlets.end_unneeded();
  schedule_->begin();
  timers.start();
  if (module.start_) module.start_();
  has_begun_ = true;
}

bool Module::Loop::turn() {
  if (module.is_done_ || !schedule_->turn()) return false;
  if (stop_requested()) throw internal::Stopped();
  return true;
}

void Module::Loop::work() {
  while (turn()) continue;
}

std::optional<Message> Module::Loop::next(internal::InputState& input) {
  end_pulled();
  if (module.is_done_) return std::nullopt;
  if (stop_requested()) throw internal::Stopped();
  for (asked_ = &input; input.waiting.empty();)
    if (has_asked_ended() || !turn()) return std::nullopt;
  auto [message, inlet] = std::move(input.waiting.front());
  input.waiting.pop_front();
  module.handled_ = internal::Handled(message.header);
  trace.note(TraceEvent::What::Began, input.name, message.header, inlet);
  note_end_ = [this, &input, inlet = inlet, header = message.header] {
    trace.note(TraceEvent::What::Ended, input.name, header, inlet);
  };
  return std::move(message);
}

void Module::Loop::end_pulled() {
  if (const auto note = std::exchange(note_end_, {})) note();
  module.handled_ = {};
}

void Module::Loop::finish() {
  inlets.sets().end_all();
  end();
}

void Module::Loop::end() {
  end_pulled();
  if (module.end_ && has_begun_) module.end_();
}

void Module::Loop::take_rest() {
  constexpr std::chrono::milliseconds kSilence{200}, kLongest{2000};
  constexpr int kPause = 5;  // [ms]
  const auto begin = module.clock_.monotonic();
  for (auto last = begin;
       now.machine - last < kSilence && now.machine - begin < kLongest && !inlets.all_ended();) {
    now.read();
    if (inlets.take_each())
      last = now.machine;
    else
      ::poll(nullptr, 0, kPause);
  }
  end();
}

void Module::Loop::serve() {
  outlets.free_removed();
  opener.log_lines(now.machine);
  trace.flush_if_due(now.machine);
  if (now.machine - served_ < kHousekeepingPeriod && now.machine < remote.due()) return;
  served_ = now.machine;
  if (module.before_waiting_) module.before_waiting_();
  // Links detect dead writers when they are waited for, which a busy module never does.
  inlets.for_each([](internal::Inlet& inlet) {
    if (inlet.is_open()) inlet.source->prepare_wait();
  });
  remote.serve();
  now.read();
}

void Module::Loop::work_between_messages() {
  inlets.end_unneeded();
  if (inlets.join_renewed()) remote.report_links();
  serve();
  timers.fire_due();
  read_watched();
}

void Module::Loop::generate() {
  trace.note(TraceEvent::What::Began, TraceEvent::kGenerator);
  module.generate_();
  trace.note(TraceEvent::What::Ended, TraceEvent::kGenerator);
}

/// Calls the handlers of the module's own descriptors that are readable. The last wait has found
/// which; without one, they are polled.
void Module::Loop::read_watched() {
  const bool is_known = std::exchange(has_waited_, false) && waits_.has_looked();
  if (!is_known && now.machine - looked_ < kLookPeriod) return;
  looked_ = now.machine;
  for (auto& watch : module.watches_) {
    if (module.is_done_) return;
    pollfd watched{watch.descriptor(), POLLIN, 0};
    if (watched.fd < 0) continue;
    if (is_known ? !waits_.was_readable(watched.fd) : ::poll(&watched, 1, 0) <= 0) continue;
    watch.handler();
    now.read();
  }
}

bool Module::Loop::wait(bool for_messages, MonotonicTime until) {
  if (for_messages && has_asked_ended()) return false;
  waited_for_.clear();
  watched_.clear();
  inlets.for_each([&](internal::Inlet& inlet) {
    if (inlet.is_open() && (for_messages || inlet.inputs.empty()))
      waited_for_.push_back(inlet.source.get());
  });
  if (for_messages)
    for (const auto& watch : module.watches_) watched_.push_back(watch.descriptor());
  if (remote.commands() != nullptr) waited_for_.push_back(remote.commands());
  until = std::min({until, remote.due(), opener.due()});
  auto timeout = std::chrono::nanoseconds(-1);
  if (until != MonotonicTime::max())
    timeout = std::max(until - now.machine, std::chrono::nanoseconds(0));
  auto& waits = for_messages ? waits_ : pauses_;
  if (module.before_waiting_) module.before_waiting_();
  const auto ready = waits.wait(waited_for_, watched_, timeout);
  has_waited_ = for_messages;
  if (!ready) internal::fail("wait", ready.error());
  if (remote.commands() != nullptr && waits.was_woken_by(*remote.commands())) served_ = {};
  return waits.was_short();
}

void Module::Loop::close() {
  if (module.before_waiting_) module.before_waiting_();
  inlets.sets().log_dropped();
  trace.flush();
  const auto closed = outlets.close();
  remote.report_counters();
  if (!closed) internal::fail(closed.error());
}

}  // namespace hc
