// SPDX-License-Identifier: Apache-2.0
#pragma once
// Bridges to ROS 2, without ROS installed: publishes outputs of the graph as topics, and subscribes
// topics as outputs of this module.

#include <atomic>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <client/running.h>
#include <frames/default_head.h>
#include <hc/module/module.h>
#include <hc/os/event.h>
#include <hc/os/loop.h>
#include <ros/joints.h>

#include "mapping.h"
#include "participant.h"
#include "publication.h"
#include "transforms.h"

struct Ros2Parameters {
  hc::Module& module;

  hc::Parameter<std::string> publish = module.parameter(
      "publish", "", "", "outputs as topics: MODULE.PORT=/topic[:TYPE] [rate=HZ], …; frames=/tf",
      {.fixed = true});
  hc::Parameter<std::string> subscribe = module.parameter(
      "subscribe", "", "", "topics as outputs: /topic[:TYPE]=OUTPUT [rate=HZ], …", {.fixed = true});
  hc::Parameter<std::string> node =
      module.parameter("node", "hypercolumn", "", "name among the nodes of ROS", {.fixed = true});
  hc::Parameter<std::int64_t> domain =
      module.parameter("domain", -1, "", "of DDS; -1: ROS_DOMAIN_ID, else 0",
                       {.min = -1, .max = 232, .fixed = true});
  hc::Parameter<std::string> range = module.parameter(
      "range", "", "", "discovery range; empty: ROS_AUTOMATIC_DISCOVERY_RANGE, else LOCALHOST",
      {.choices = {"", "LOCALHOST", "SUBNET", "OFF"}, .fixed = true});
  hc::Parameter<std::string> distro = module.parameter(
      "distro", "", "", "ROS distribution; humble has another protocol; empty: ROS_DISTRO",
      {.fixed = true});
  hc::Parameter<std::string> frames = module.parameter(
      "frames", std::string(hc::frames::kDefaultHead), "",
      "coordinate systems, by `hc run`; else of the default head", {.fixed = true});

  /// Empty parameters by the environment. An invalid ROS_DOMAIN_ID ends the module.
  [[nodiscard]] Participant::Options participant() const;
};

class Ros2 {
 public:
  /// @param module  must outlive it.
  explicit Ros2(hc::Module& module);

 private:
  /// An output of this module.
  struct Destination {
    hc::PortType port;
    std::function<void(hc::Message)> send;
  };
  /// A subscribed topic, and the destination of its messages.
  struct Subscription {
    Mapping subscribed;
    const Destination& to;
    RateLimit limit;
    Reader reader;
  };
  using Bytes = hc::Result<std::span<const std::byte>>;

  void start();
  void subscribe(const Mapping& subscribed);
  void publish(const Mapping& published, const std::optional<hc::RunningGraph>& graph);
  void publish_frames(const Mapping& published);

  void take(Subscription& from, const Bytes& bytes);
  void write_pose(const hc::Message& pose);
  /// Logs a problem from another thread; the number of queued lines is bounded.
  void log(const std::string& kind, const std::string& line);

  static std::map<std::string, Destination> add_outputs(hc::Module& module);

  hc::Module& module_;
  hc::Input<hc::TransformationKind<double>> poses_ =
      module_.input("frames", hc::transformation(), "poses, linked by `hc run`");
  const std::map<std::string, Destination> outputs_ = add_outputs(module_);
  const Ros2Parameters parameters_{module_};

  const std::unique_ptr<hc::Loop> loop_;
  std::atomic<int> waiting_{0};  // lines to log
  hc::Event arrived_;            // messages
  // Called on threads of Cyclone DDS.
  const std::function<void(std::string_view)> warn_ = [this](std::string_view line) {
    log("warnings of Cyclone DDS", "Cyclone DDS: " + std::string(line));
  };
  const std::function<void()> wake_ = [this] { arrived_.raise(); };

  std::optional<hc::ros::GraphJoints> joints_;
  // What uses the participant ends before it.
  std::unique_ptr<Participant> participant_;
  std::optional<Transforms> transforms_;
  std::list<Subscription> subscriptions_;
  std::list<Publication> publications_;
};
