// SPDX-License-Identifier: Apache-2.0
#include <client/tap.h>

#include <poll.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include <client/graph_client.h>
#include <client/running.h>

namespace hc {
namespace {

/// A source that ends with the graph, not with the link, since modules restart.
class TapSource final : public Source {
 public:
  static Result<std::unique_ptr<Source>> make(std::unique_ptr<Source> source, Descriptor graph) {
    auto both =
        HC_TRY(open_descriptor("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); }));
    for (const auto& [number, events] :
         {std::pair(source->descriptor(), EPOLLIN), {graph.get(), EPOLLRDHUP}}) {
      epoll_event event{static_cast<std::uint32_t>(events), {}};
      HC_TRY(system_call("epoll_ctl", "", [&, watched = number] {
        return ::epoll_ctl(both.get(), EPOLL_CTL_ADD, watched, &event);
      }));
    }
    return std::unique_ptr<Source>(
        new TapSource(std::move(source), std::move(graph), std::move(both)));
  }

  Result<Got> take(Message& message) override {
    auto got = source_->take(message);
    return got && *got == Got::Nothing && has_ended() ? Got::End : got;
  }
  [[nodiscard]] int descriptor() const override { return both_.get(); }
  [[nodiscard]] int wake_descriptor() const override { return source_->wake_descriptor(); }
  bool prepare_wait() override { return source_->prepare_wait(); }
  [[nodiscard]] Spin spin() const override { return source_->spin(); }
  [[nodiscard]] Traffic traffic() const override { return source_->traffic(); }

 private:
  TapSource(std::unique_ptr<Source> source, Descriptor graph, Descriptor both)
      : source_(std::move(source)), graph_(std::move(graph)), both_(std::move(both)) {}

  [[nodiscard]] bool has_ended() const {
    pollfd polled{graph_.get(), POLLRDHUP, 0};
    return ::poll(&polled, 1, 0) > 0;
  }

  std::unique_ptr<Source> source_;
  Descriptor graph_;  // a connection that closes with the graph
  Descriptor both_;
};

Result<Uri> ask_uri(const RunningGraph& graph, const std::string& question, int stop) {
  auto answer = HC_TRY(ask(graph, {question}, stop));
  if (!answer.is_ok || answer.rows.empty())
    return Error{Code::Invalid, answer.is_ok ? "no URI in the answer" : answer.rows.back()};
  return parse_uri(answer.rows.front());
}

/// Lowers the priority of this thread below the robot's modules, and not below those in background:
/// a person may steer by its images. If that fails, it merely competes with the modules.
void yield_to_robot() {
  constexpr int kNice = 5;
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kNice));
  const sched_param none{};
  static_cast<void>(::sched_setscheduler(0, SCHED_BATCH, &none));
}

Event make_event() {
  auto made = Event::make();
  if (!made) throw std::runtime_error(made.error().text());
  return std::move(*made);
}

}  // namespace

Result<Uri> tap_uri(const RunningGraph& graph, const std::string& port, int stop) {
  return ask_uri(graph, "observe " + port, stop);
}

Result<Uri> feed_uri(const RunningGraph& graph, const std::string& port, int stop) {
  auto uri = HC_TRY(ask_uri(graph, "feed " + port, stop));
  uri.options.emplace_back("wait", "5");  // the module is about to listen
  return uri;
}

Result<std::unique_ptr<Source>> open_tap(const RunningGraph& graph, const std::string& port,
                                         const LinkOptions& options) {
  auto connection = HC_TRY(connect_to(graph));
  auto uri = HC_TRY(tap_uri(graph, port, options.stop));
  uri.options.emplace_back("reconnect", "86400");
  auto source = HC_TRY(open_source(uri, options));
  return TapSource::make(std::move(source), std::move(connection));
}

Tap::Tap(RunningGraph graph, std::string port, Callbacks callbacks)
    : graph_(std::move(graph)),
      port_(std::move(port)),
      callbacks_(std::move(callbacks)),
      wake_(make_event()),
      thread_([this] { run(); }) {}

Tap::~Tap() {
  is_stopped_ = true;
  wake_.raise();
  thread_.join();
}

void Tap::wake() {
  if (is_open_) wake_.raise();  // earlier, it would abort opening the output
}

void Tap::run() {
  yield_to_robot();
  try {
    read();
  } catch (const std::exception& error) {  // affects only this tap
    if (!is_stopped_) callbacks_.end(error.what(), true);
  }
}

void Tap::read() {
  auto end = [&](const std::string& why, bool is_error) {
    if (!is_stopped_) callbacks_.end(why, is_error);
  };
  LinkOptions options;
  options.stop = wake_.descriptor();
  auto source = open_tap(graph_, port_, options);
  if (!source) return end(source.error().detail, true);
  is_open_ = true;
  callbacks_.open();
  Message message;
  while (!is_stopped_) {
    const auto got = (*source)->take(message);
    if (!got) return end(got.error().detail, true);
    if (*got == Got::End) return end("the graph has ended", false);
    if (*got == Got::Message) {
      callbacks_.message(message);
      continue;  // more may have arrived
    }
    message = {};
    const auto next = callbacks_.idle();
    const auto wait =
        next == Clock::time_point::max()
            ? std::chrono::milliseconds(-1)
            : std::max(std::chrono::milliseconds(0),
                       std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now()));
    const auto waited = (*source)->wait(wake_.descriptor(), wait);
    if (waited) continue;
    if (waited.error().code != Code::Stopped) return end(waited.error().detail, true);
    wake_.clear();
  }
}

}  // namespace hc
