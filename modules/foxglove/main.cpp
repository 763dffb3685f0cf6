// SPDX-License-Identifier: Apache-2.0
// Shows the graph in Foxglove and Lichtblick, live: topics on demand, parameters, frames, log.
#include <memory>

#include <client/running.h>
#include <frames/default_head.h>
#include <hc/module/module.h>
#include <ros/joints.h>
#include <transports/all.h>
#include <web/service.h>

#include "bridge.h"

namespace web = hc::web;

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "foxglove", "Shows the graph in Foxglove and Lichtblick, live.", {.keep_running = true}};
  auto poses = module.input("frames", hc::transformation(), "poses, linked by `hc run`");
  auto listen = module.parameter(
      "listen", "127.0.0.1", "",
      "IP address; any but 127.0.0.1 is open to other machines, with TLS only", {.fixed = true});
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

  const auto loop = hc::value_or_end(hc::Loop::make());
  std::unique_ptr<web::Service> service;
  Bridge* bridge = nullptr;  // owned by the service
  module.on_start([&] {
    const auto graph = hc::own_graph();
    if (!graph)
      throw hc::ModuleError(
          "HC_GRAPH does not name a running graph, NAME.PID; run this module in a graph, or add it "
          "to one: hc graph add foxglove foxglove");
    auto joints = hc::value_or_refuse(frames, hc::ros::GraphJoints::read(*frames));
    service =
        hc::value_or_end(web::Service::open({*listen, static_cast<int>(*port), *tls, *hosts}, *loop,
                                            [&](std::string_view line) { module.log(line); }));
    auto& access = service->access();
    module.log("foxglove: " + access.invite_socket(web::Right::Operate), hc::Level::Notice);
    module.log("foxglove, view only: " + access.invite_socket(web::Right::View), hc::Level::Notice);
    if (!service->fingerprint().empty())
      module.log("foxglove: certificate " + service->fingerprint(), hc::Level::Notice);
    bridge = &service->serve(std::make_unique<Bridge>(
        Bridge::Options{*graph, std::move(joints), *images == "jpeg"}, access, service->server()));
  });
  module.on_readable([&] { return loop->descriptor(); },
                     [&] { hc::succeed_or_end(loop->turn(std::chrono::milliseconds(0))); });
  module.on(poses, [&](const auto& pose) {
    if (const auto moved = bridge->move(pose); !moved)
      module.log_once("pose", moved.error().detail);
  });
  return module.run(argc, argv);
}
