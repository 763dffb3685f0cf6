// SPDX-License-Identifier: Apache-2.0
// Serves a page in the browser: the graph live, its streams, and the driver's seat.
#include <linux/close_range.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>

#include <client/running.h>
#include <hc/module/module.h>

#include <transports/all.h>
#include <web/qr.h>
#include <web/service.h>
#include "page.h"
#include "stop.h"

namespace {

constexpr std::uint32_t kTexts = 8;  // queue of texts to speak
constexpr std::uint32_t kBids = 4;   // queue of bids: the newest and withdrawals

/// An output for the driver's commands.
struct Commanded {
  std::function<void(const hc::Message&)> send;
  std::function<bool()> linked;
};

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

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"web", "Serves a page: the graph live, its streams, and the driver's seat.", {.keep_running = true}};
  auto stopped = module.input("stopped", hc::table<std::uint8_t>().of(1, 1),
                              "from workspace: 1 while the robot is stopped", {.keep = 1});
  auto stick = module.output("stick", hc::table().of(1, 2),
                             "left > 0, down > 0, each -1 to 1, from the driver", {.keep = 1});
  auto rotation = module.output("rotation", hc::rotation().in(hc::Coord::kSupervisor),
                                "roll, pitch, yaw of the driver's head [rad]", {.keep = 1});
  auto target = module.output("target", hc::position(),
                              "selected point: x, y in the left (7) or right (8) image [px]", {.keep = 1});
  auto text = module.output("text", hc::string(), "to speak", {.keep = kTexts});
  auto bid = module.output("bid", hc::table(), "for the task chosen by the driver", {.keep = kBids});
  auto stop = module.output("stop", hc::table<std::uint8_t>().of(1, 1),
                            "1, repeated: stop the robot; 0, repeated: no stop, and a page is "
                            "open; 2: a person clears all stops; 3: no page is open any more", {.keep = 1});
  // A slow reader of the driver's commands must never delay the stop.
  auto listen = module.parameter(
      "listen", "127.0.0.1", "",
      "IP address; any but 127.0.0.1 is open to other machines, with TLS only", {.fixed = true});
  auto port = module.parameter("port", 8470, "", "the next nine are tried too; 0: any",
                               {.min = 0, .max = 65526, .fixed = true});
  auto tls = module.parameter("tls", false, "", "use TLS on 127.0.0.1 too", {.fixed = true});
  auto hosts = module.parameter("hosts", "", "", "names by which browsers may call this machine",
                                {.fixed = true});
  auto browser = module.parameter("browser", false, "",
                                  "open the page where there is a desktop, if listen is local",
                                  {.fixed = true});
  auto recordings =
      module.parameter("recordings", "recordings", "", "folder for recordings", {.fixed = true});
  auto frames =
      module.parameter("frames", "", "", "coordinate systems, by `hc run`", {.fixed = true});
  auto leave =
      module.parameter("leave", 0.0, "s", "end after this time without an open page; 0: never",
                       {.min = 0, .max = 1e6});

  const auto make_loop = [] { return hc::value_or_end(hc::Loop::make()); };
  const auto stops = make_loop(), loop = make_loop();  // stops have priority
  Robot robot;
  std::optional<Stop> wanted;
  hc::MonotonicTime seen{};  // when a page was last open

  std::int64_t ordered = 0;  // when a person last stopped the robot or cleared the stop [ns]
  auto send_stop = [&](Stop::Word word, std::int64_t said) {
    stop.send({static_cast<std::uint8_t>(word)}, said);
  };
  const auto control_of = [](auto& output) -> Commanded {
    return {[&](const hc::Message& message) { output.send({message}); },
            [&] { return output.linked(); }};
  };
  const Commanded controls[kControls] = {{},  // in the order of Control
                                         control_of(stick),
                                         control_of(rotation),
                                         control_of(target),
                                         control_of(text),
                                         control_of(bid)};

  std::unique_ptr<web::Service> service;
  module.on_start([&] {
    const auto graph = hc::own_graph();
    if (!graph)
      throw hc::ModuleError(
          "HC_GRAPH does not name a running graph, NAME.PID; run this module in "
          "a graph, or with hc run GRAPH --page");
    service =
        hc::value_or_end(web::Service::open({*listen, static_cast<int>(*port), *tls, *hosts}, *loop,
                                            [&](std::string_view line) { module.log(line); }));
    wanted.emplace(module.instance());
    auto& access = service->access();
    const std::string url = access.invite(web::Right::Operate);
    module.log("page: " + url, hc::Level::Notice);
    if (!service->fingerprint().empty())
      module.log("page: certificate " + service->fingerprint(), hc::Level::Notice);
    if (!web::is_local(*listen))
      for (const auto& line : web::qr_lines(access.invite(web::Right::Operate)))
        module.log(line, hc::Level::Notice);
    service->serve(std::make_unique<Page>(
        Page::Options{*graph, module.instance(), *frames, *recordings}, access, service->server(),
        robot,
        Page::Callbacks{
            [&](const Order& order) {
              loop->post([&send = controls[static_cast<std::size_t>(order.control)].send,
                          message = order.message] { send(message); });
            },
            [&](bool stops_robot, Stop::Answer answer) {
              stops->post([&, stops_robot, answer = std::move(answer)] {
                ordered = module.now();
                send_stop(wanted->order(stops_robot, stop.linked(), module.monotonic(), answer),
                          ordered);
              });
            },
            [&](hc::Level level, std::string_view line) {
              // An error of a page is not an error of the run.
              const auto told = level == hc::Level::Notice ? level : hc::Level::Info;
              loop->post([&, told, kept = std::string(line)] { module.log(kept, told); });
            }}));
    if (*browser && web::is_local(*listen)) open_in_browser(url);
    seen = module.monotonic();
  });
  for (auto* each : {stops.get(), loop.get()})
    module.on_readable([each] { return each->descriptor(); },
                       [each] { hc::succeed_or_end(each->turn(std::chrono::milliseconds(0))); });
  auto show_stopped = [&] {
    const auto said = wanted->is_stopped(module.monotonic());
    robot.stopped = !said ? Stopped::Unknown : *said ? Stopped::Yes : Stopped::No;
  };
  module.on(stopped, [&](const auto& message) {
    wanted->hear(message.numbers()[0] != 0, module.monotonic());
    show_stopped();
  });
  // Nothing while the server hangs, since a stop could not arrive.
  auto is_guarded = [&]() -> std::optional<bool> {
    if (module.monotonic() - robot.served.load() > Stop::kHung) return std::nullopt;
    return robot.sessions > 0;
  };
  module.every(Stop::kPeriod, [&] {
    if (const auto word = wanted->tick(is_guarded(), module.monotonic()))
      send_stop(*word, *word == Stop::Word::Clear ? ordered : module.now());
    show_stopped();
  });
  module.every(std::chrono::milliseconds(100), [&] {
    unsigned bits = 0;
    for (std::size_t i = 1; i < std::size(controls); ++i)
      bits |= controls[i].linked() ? 1U << i : 0U;
    robot.linked = bits;
    const auto now = module.monotonic();
    if (robot.sessions > 0) seen = now;
    if (*leave > 0 && now - seen > hc::duration(*leave)) {
      module.log("no page has been open for " + std::to_string(static_cast<int>(*leave)) + " s");
      std::raise(SIGTERM);
    }
  });
  return module.run(argc, argv);
}
