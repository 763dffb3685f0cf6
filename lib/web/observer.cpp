// SPDX-License-Identifier: Apache-2.0
#include <web/observer.h>

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace hc::web {
namespace {

/// Has this thread yield the processor to the robot's modules, which are not to wait for those who
/// look on. What is refused changes nothing but the speed.
void yield_to_robot() {
  constexpr int kNice = 10;
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kNice));
  const sched_param none{};
  static_cast<void>(::sched_setscheduler(0, SCHED_BATCH, &none));
}

}  // namespace

Observer::Observer(RunningGraph graph, std::string port, Callbacks callbacks)
    : graph_(std::move(graph)),
      port_(std::move(port)),
      callbacks_(std::move(callbacks)),
      thread_([this] { run(); }) {}

Observer::~Observer() {
  is_stopped_ = true;
  wake_.raise();
  thread_.join();
}

void Observer::wake() {
  if (is_open_) wake_.raise();  // before, it would end the wait for the output
}

void Observer::run() {
  yield_to_robot();
  try {
    observe();
  } catch (const std::exception& error) {  // of who looks on: the others are served on
    if (!is_stopped_) callbacks_.end(error.what(), true);
  }
}

void Observer::observe() {
  constexpr std::chrono::seconds kRenewal{1};
  auto end = [&](const std::string& why, bool is_error) {
    if (!is_stopped_) callbacks_.end(why, is_error);
  };
  auto observation = Observation::make(graph_, port_, wake_.descriptor());
  if (!observation) return end(observation.error().detail, true);
  LinkOptions options;
  options.stop = wake_.descriptor();
  auto source = open_source(parse_uri(observation->uri()).value(), options);
  if (!source) return end(source.error().detail, true);
  is_open_ = true;
  callbacks_.open();
  Message message;
  auto renewed = Clock::now();
  while (!is_stopped_) {
    const auto got = (*source)->take(message);
    if (!got) return end(got.error().detail, true);
    if (*got == Got::End) return end("the stream has ended", false);
    const auto now = Clock::now();
    if (now >= renewed + kRenewal) {
      if (!observation->renew()) return end("the graph has ended", false);
      renewed = now;
    }
    if (*got == Got::Message) {
      callbacks_.message(message);
      continue;  // a newer one may be there
    }
    message = {};
    const auto next = std::min(renewed + kRenewal, callbacks_.idle());
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now());
    const auto waited =
        (*source)->wait(wake_.descriptor(), std::max(wait, std::chrono::milliseconds(0)));
    if (waited) continue;
    if (waited.error().code != Code::Stopped) return end(waited.error().detail, true);
    wake_.clear();
  }
}

}  // namespace hc::web
