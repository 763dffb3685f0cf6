// SPDX-License-Identifier: Apache-2.0
#include "web.h"

#include <linux/close_range.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <utility>

#include <client/running.h>

#include <web/qr.h>

namespace {

/// Opens a URL in the browser of a desktop, if there is one.
void open_in_browser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  const pid_t child = ::fork();
  if (child != 0) return;
  ::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);  // so that it does not inherit the server's sockets
  ::execlp("xdg-open", "xdg-open", url.c_str(), nullptr);
  ::_exit(127);
}

}  // namespace

Web::Web(hc::Module& module)
    : module_(module),
      stops_(hc::value_or_end(hc::Loop::make())),
      loop_(hc::value_or_end(hc::Loop::make())) {
  module.on_start([this] { start(); });
  turn_on_readable(*stops_);
  turn_on_readable(*loop_);
  module.on(stopped_, [this](const auto& message) {
    wanted_->hear(message.numbers()[0] != 0, module_.monotonic());
    show_stopped();
  });
  module.every(Stop::kPeriod, [this] { repeat_stop(); });
  module.every(std::chrono::milliseconds(100), [this] {
    robot_.linked = outputs_.linked();
    leave_when_unseen();
  });
}

void Web::turn_on_readable(hc::Loop& loop) {
  module_.on_readable([&loop] { return loop.descriptor(); },
                      [&loop] { hc::succeed_or_end(loop.turn(std::chrono::milliseconds(0))); });
}

void Web::start() {
  const auto graph = hc::own_graph();
  if (!graph)
    throw hc::ModuleError(
        "HC_GRAPH does not name a running graph, NAME.PID; run this module in "
        "a graph, or with hc run GRAPH --page");
  const auto& given = parameters_;
  service_ = hc::value_or_end(
      web::Service::open({*given.listen, static_cast<int>(*given.port), *given.tls, *given.hosts},
                         *loop_, [this](std::string_view line) { module_.log(line); }));
  wanted_.emplace(module_.instance());
  auto& access = service_->access();
  const std::string url = access.invite(web::Right::Operate);
  log_how_to_open(url);
  service_->serve(std::make_unique<Page>(
      Page::Options{*graph, module_.instance(), *given.frames, *given.recordings}, access,
      service_->server(), robot_, callbacks()));
  if (*given.browser && web::is_local(*given.listen)) open_in_browser(url);
  seen_ = module_.monotonic();
}

void Web::log_how_to_open(const std::string& url) {
  module_.log("page: " + url, hc::Level::Notice);
  if (!service_->fingerprint().empty())
    module_.log("page: certificate " + service_->fingerprint(), hc::Level::Notice);
  if (!web::is_local(*parameters_.listen))
    for (const auto& line : web::qr_lines(service_->access().invite(web::Right::Operate)))
      module_.log(line, hc::Level::Notice);
}

Page::Callbacks Web::callbacks() {
  return {
      [this](const Order& order) { loop_->post([this, order] { outputs_.send(order); }); },
      [this](bool stops_robot, Stop::Answer answer) { order_stop(stops_robot, std::move(answer)); },
      [this](hc::Level level, std::string_view line) {
        // An error of a page is not an error of the run.
        const auto as = level == hc::Level::Notice ? level : hc::Level::Info;
        loop_->post([this, as, kept = std::string(line)] { module_.log(kept, as); });
      }};
}

void Web::order_stop(bool stops_robot, Stop::Answer answer) {
  stops_->post([this, stops_robot, answer = std::move(answer)] {
    ordered_ = module_.now();
    send_stop(wanted_->order(stops_robot, stop_.linked(), module_.monotonic(), answer), ordered_);
  });
}

void Web::send_stop(Stop::Word word, hc::Time said) {
  stop_.send(static_cast<std::uint8_t>(word), said);
}

void Web::repeat_stop() {
  if (const auto word = wanted_->tick(is_guarded(), module_.monotonic()))
    send_stop(*word, *word == Stop::Word::Clear ? ordered_ : module_.now());
  show_stopped();
}

void Web::show_stopped() {
  const auto said = wanted_->is_stopped(module_.monotonic());
  robot_.stopped = !said ? Stopped::Unknown : *said ? Stopped::Yes : Stopped::No;
}

void Web::leave_when_unseen() {
  const double leave = *parameters_.leave;
  const auto now = module_.monotonic();
  if (robot_.sessions > 0) seen_ = now;
  if (leave > 0 && now - seen_ > hc::duration(leave)) {
    module_.log("no page has been open for " + std::to_string(static_cast<int>(leave)) + " s");
    std::raise(SIGTERM);
  }
}

std::optional<bool> Web::is_guarded() const {
  if (module_.monotonic() - robot_.served.load() > Stop::kHung) return std::nullopt;
  return robot_.sessions > 0;
}
