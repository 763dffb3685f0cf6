// SPDX-License-Identifier: Apache-2.0
// Shows the graph in Foxglove and Lichtblick, live: topics on demand, parameters, frames, log.
#include <cstdlib>
#include <optional>
#include <thread>

#include <frames/default_head.h>
#include <hc/module/module.h>
#include <ros/joints.h>
#include <web/inbox.h>
#include <web/listening.h>

#include "bridge.h"

namespace web = hc::web;

int main(int argc, char** argv) {
  hc::Module module{"foxglove", "Shows the graph in Foxglove and Lichtblick, live."};
  auto poses =
      module.input("frames", hc::transformation<double>(4, 4), "poses, linked by `hc run`");
  auto listen = module.parameter(
      "listen", "127.0.0.1", "",
      "IP address; other machines can reach any but 127.0.0.1, with TLS alone", {.fixed = true});
  auto port = module.parameter("port", 8765, "", "the next nine are tried too; 0: any",
                               {.min = 0, .max = 65526, .fixed = true});
  auto tls = module.parameter("tls", false, "", "use TLS on 127.0.0.1 too", {.fixed = true});
  auto hosts = module.parameter("hosts", "", "", "names by which viewers may call this machine",
                                {.fixed = true});
  auto images = module.parameter("images", "raw", "", "how images of u8 are sent",
                                 {.choices = {"raw", "jpeg"}, .fixed = true});
  auto frames = module.parameter("frames", std::string(hc::frames::kDefaultHead), "",
                                 "coordinate systems, by `hc run`; else those of the default head",
                                 {.fixed = true});

  web::Inbox inbox;
  std::optional<hc::ros::GraphJoints> joints;
  std::optional<web::Access> access;
  std::unique_ptr<web::Server> server;
  std::unique_ptr<Bridge> bridge;
  std::thread thread;

  // From any thread.
  const auto log = [&](hc::Severity, std::string_view line) {
    inbox.put([&, kept = std::string(line)] { module.log(kept); });
  };

  module.on_start([&] {
    const char* name = std::getenv("HC_GRAPH");
    const auto graph = hc::parse_running(name == nullptr ? "" : name);
    if (!graph)
      throw hc::ModuleError(
          "HC_GRAPH does not name a running graph, NAME.PID; run this module in a graph, or add it "
          "to one: hc graph add foxglove foxglove");
    joints = hc::value_or_end(hc::ros::GraphJoints::read(*frames));
    auto opened =
        hc::value_or_end(web::open_server({*listen, static_cast<int>(*port), *tls, *hosts}, log));
    server = std::move(opened.server);
    access.emplace(opened.place);
    bridge = std::make_unique<Bridge>(Bridge::Options{*graph, joints->names, joints->fixed,
                                                      *images == "jpeg", [&] { bridge->close(); }},
                                      *access, *server);
    const std::string url =
        std::string(opened.place.is_secure ? "wss://" : "ws://") + access->authority() + "/?token=";
    module.log("notice: foxglove: " + url + access->begin_session(web::Right::Drive));
    module.log("notice: foxglove, to view alone: " + url + access->begin_session(web::Right::View));
    if (!opened.fingerprint.empty())
      module.log("notice: foxglove: certificate " + opened.fingerprint);
    thread = std::thread([&] { server->run(*bridge); });
  });
  module.keep_running();
  module.on_readable([&] { return inbox.descriptor(); }, [&] { inbox.work_off(); });
  module.on(poses, [&](const auto& pose) {
    const auto joint = joints->joint_of(pose);
    if (!joint) return module.log_once("pose", joint.error().detail);
    server->post([&, kept = *joint] { bridge->move(kept); });
  });
  const int status = module.run(argc, argv);
  if (bridge) server->post([&] { bridge->close(); });
  if (server) server->stop();
  if (thread.joinable()) thread.join();
  bridge.reset();
  return status;
}
