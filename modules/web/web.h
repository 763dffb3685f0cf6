// SPDX-License-Identifier: Apache-2.0
#pragma once
// Serves a page in the browser: the graph live, its streams, and the driver's seat.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <hc/module/module.h>
#include <hc/os/loop.h>

#include <web/service.h>
#include "driver_outputs.h"
#include "page.h"
#include "stop.h"

struct WebParameters {
  hc::Module& module;

  hc::Parameter<std::string> listen = module.parameter(
      "listen", "127.0.0.1", "",
      "IP address; any but 127.0.0.1 is open to other machines, with TLS only", {.fixed = true});
  hc::Parameter<std::int64_t> port =
      module.parameter("port", 8470, "", "the next nine are tried too; 0: any",
                       {.min = 0, .max = 65526, .fixed = true});
  hc::Parameter<bool> tls =
      module.parameter("tls", false, "", "use TLS on 127.0.0.1 too", {.fixed = true});
  hc::Parameter<std::string> hosts = module.parameter(
      "hosts", "", "", "names by which browsers may call this machine", {.fixed = true});
  hc::Parameter<bool> browser = module.parameter(
      "browser", false, "", "open the page where there is a desktop, if listen is local",
      {.fixed = true});
  hc::Parameter<std::string> recordings =
      module.parameter("recordings", "recordings", "", "folder for recordings", {.fixed = true});
  hc::Parameter<std::string> frames =
      module.parameter("frames", "", "", "coordinate systems, by `hc run`", {.fixed = true});
  hc::Parameter<double> leave =
      module.parameter("leave", 0.0, "s", "end after this time without an open page; 0: never",
                       {.min = 0, .max = 1e6});
};

class Web {
 public:
  /// @param module  must outlive it.
  explicit Web(hc::Module& module);

 private:
  void start();
  void log_how_to_open(const std::string& url);
  void turn_on_readable(hc::Loop& loop);

  /// What the server calls on its thread, as order_stop().
  [[nodiscard]] Page::Callbacks callbacks();
  void order_stop(bool stops_robot, Stop::Answer answer);

  void send_stop(Stop::Word word, hc::Time said);
  void repeat_stop();
  void show_stopped();
  /// Ends the program when no page has been open for long.
  void leave_when_unseen();
  /// Whether a page is open. Nothing while the server hangs, since a stop could not arrive.
  [[nodiscard]] std::optional<bool> is_guarded() const;

  hc::Module& module_;
  hc::Input<hc::TableKind<std::uint8_t>> stopped_ =
      module_.input("stopped", hc::table<std::uint8_t>().of(1, 1),
                    "from workspace: 1 while the robot is stopped", {.keep = 1});
  DriverOutputs outputs_{module_};
  hc::Output<hc::TableKind<std::uint8_t>> stop_ =
      module_.output("stop", hc::table<std::uint8_t>().of(1, 1),
                     "1, repeated: stop the robot; 0, repeated: no stop, and a page is "
                     "open; 2: a person clears all stops; 3: no page is open any more",
                     {.keep = 1});
  WebParameters parameters_{module_};

  const std::unique_ptr<hc::Loop> stops_, loop_;  // stops have priority
  Robot robot_;
  std::optional<Stop> wanted_;
  hc::MonotonicTime seen_{};  // when a page was last open
  hc::Time ordered_;          // when a person last stopped the robot or cleared the stop
  std::unique_ptr<web::Service> service_;
};
