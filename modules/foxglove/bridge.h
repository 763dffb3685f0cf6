// SPDX-License-Identifier: Apache-2.0
#pragma once
// Serves a running graph in Foxglove's WebSocket protocol (doc/foxglove.md). For the server's
// thread.

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <client/graph_client.h>
#include <hc/base/clock.h>
#include <ros/encode.h>
#include <ros/joints.h>
#include <web/access.h>
#include <web/server.h>

#include "catalog.h"
#include "json.h"
#include "publisher.h"
#include "viewer.h"

class Bridge final : public hc::web::Site {
 public:
  struct Options {
    hc::RunningGraph graph;
    hc::ros::GraphJoints joints;
    bool jpeg = false;
  };

  Bridge(Options options, hc::web::Access& access, hc::web::Server& server);

  hc::web::Reply reply(const hc::web::Request& request) override;
  void open(std::shared_ptr<hc::web::WebSocket> socket, const hc::web::Request& request) override;

  void close() override;

  /// Takes the pose of a moving frame. From any thread. Errors: as GraphJoints::joint_of().
  hc::Status move(const hc::Message& pose);

 private:
  void take_text(const std::shared_ptr<Viewer>& viewer, std::string_view line);
  void subscribe(Viewer& viewer, const Json& request);
  void unsubscribe(Viewer& viewer, const Json& request);
  void get_parameters(Viewer& viewer, const Json& request);
  void set_parameters(const std::shared_ptr<Viewer>& viewer, const Json& request);

  void move(const hc::ros::Joint& joint);
  void take_log(const hc::LogLine& line);
  void apply(const Catalog::Changes& changes);
  void publish(std::uint32_t channel, const Payload& payload);
  void publish_frames();
  [[nodiscard]] bool is_subscribed(std::uint32_t channel) const;
  void remove(const Viewer* viewer);
  void tick();

  const Options options_;
  hc::web::Access& access_;
  hc::web::Server& server_;
  const hc::SystemClock clock_;
  const std::string session_;
  Catalog catalog_;
  hc::ros::Encoder encoder_;
  std::map<std::string, hc::ros::Joint> joints_;  // by child
  std::list<std::shared_ptr<Viewer>> viewers_;
  std::map<std::uint32_t, std::unique_ptr<Publisher>> publishers_;  // by channel
  hc::Time reported_;                                               // last report of drops
  hc::GraphClient graph_;
};
