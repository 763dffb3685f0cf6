// SPDX-License-Identifier: Apache-2.0
// Bridges to ROS 2, without ROS installed: publishes outputs of the graph as topics, and subscribes
// topics as outputs of this module.
#include <atomic>
#include <cstdlib>
#include <functional>
#include <list>
#include <map>
#include <optional>

#include <client/running.h>
#include <frames/default_head.h>
#include <hc/base/text.h>
#include <hc/compress/compress.h>
#include <hc/module/module.h>
#include <hc/os/event.h>
#include <hc/os/loop.h>
#include <ros/decode.h>
#include <ros/joints.h>
#include <transports/all.h>

#include "mapping.h"
#include "names.h"
#include "participant.h"
#include "publication.h"

namespace {

std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : value;
}

/// The DDS domain; for a negative parameter that of ROS_DOMAIN_ID.
std::uint32_t domain_of(std::int64_t parameter) {
  if (parameter >= 0) return static_cast<std::uint32_t>(parameter);
  const std::string text = environment("ROS_DOMAIN_ID", "0");
  std::uint32_t domain = 0;
  if (!hc::read_number(text, domain))
    throw hc::ModuleError(
        hc::Error{hc::Code::Invalid, "ROS_DOMAIN_ID is \"" + text + "\", not a number"});
  return domain;
}

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

/// The frames as /tf and /tf_static.
struct Frames {
  double rate = 0;
  Writer moving, fixed;
  hc::ros::Encoder encoder;
  std::map<std::string, RateLimit> limits;  // by child
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"ros2", "Talks to ROS 2: outputs of the graph as topics, and topics here.", {.keep_running = true}};
  auto poses =
      module.input("frames", hc::transformation(), "poses, linked by `hc run`");
  std::map<std::string, Destination> outputs;
  const auto add = [&]<typename K>(const std::string& name, const K& kind, const char* doc) {
    outputs[name] = {kind.type,
                     [output = module.output(name, kind, doc)](hc::Message message) mutable {
                       output.send(hc::MessageOf<K>{std::move(message)});
                     }};
  };
  add("image", hc::rgb_image(), "of Image or CompressedImage");
  add("grey", hc::intensity_image(), "of Image or CompressedImage");
  add("depth", hc::intensity_image<float>(), "of Image [m], 0 unknown");
  auto points = hc::position<float>();
  points.type.info.encoding = hc::Encoding::Binary;  // there are many
  add("points", points, "of PointCloud2");
  add("camera", hc::table().of(1, 5), "of CameraInfo: fx, fy, cx, cy [px], baseline [m]");
  add("pose", hc::transformation(), "of PoseStamped or TFMessage");
  add("twist", hc::table().of(1, 6), "of Twist: linear, angular");
  add("joints", hc::table(),
      "of JointState: a row of positions, then of velocities and efforts");
  add("text", hc::string(), "of String");
  add("numbers", hc::table(), "of Float64MultiArray");
  const auto publish = module.parameter(
      "publish", "", "", "outputs as topics: MODULE.PORT=/topic[:TYPE] [rate=HZ], …; frames=/tf",
      {.fixed = true});
  const auto subscribe = module.parameter(
      "subscribe", "", "", "topics as outputs: /topic[:TYPE]=OUTPUT [rate=HZ], …", {.fixed = true});
  const auto node =
      module.parameter("node", "hypercolumn", "", "name among the nodes of ROS", {.fixed = true});
  const auto domain = module.parameter("domain", -1, "", "of DDS; -1: ROS_DOMAIN_ID, else 0",
                                       {.min = -1, .max = 232, .fixed = true});
  const auto range = module.parameter(
      "range", "", "", "discovery range; empty: ROS_AUTOMATIC_DISCOVERY_RANGE, else LOCALHOST",
      {.choices = {"", "LOCALHOST", "SUBNET", "OFF"}, .fixed = true});
  const auto distro = module.parameter(
      "distro", "", "", "ROS distribution; humble has another protocol; empty: ROS_DISTRO",
      {.fixed = true});
  const auto frames = module.parameter("frames", std::string(hc::frames::kDefaultHead), "",
                                       "coordinate systems, by `hc run`; else of the default head",
                                       {.fixed = true});

  // Called on other threads. The number of queued lines is bounded.
  const auto loop = hc::value_or_end(hc::Loop::make());
  std::atomic<int> waiting{0};
  const auto log = [&](const std::string& kind, const std::string& line) {
    constexpr int kMostWaiting = 1000;
    if (waiting >= kMostWaiting) return;
    ++waiting;
    loop->post([&, kind, line] {
      --waiting;
      module.log_once(kind, line);
    });
  };
  const std::function<void(std::string_view)> warn = [&](std::string_view line) {
    log("warnings of Cyclone DDS", "Cyclone DDS: " + std::string(line));
  };
  const auto arrived = hc::value_or_end(hc::Event::make());
  const std::function<void()> wake = [&] { arrived.raise(); };

  std::optional<hc::ros::GraphJoints> joints;
  std::unique_ptr<Participant> participant;
  std::list<Subscription> subscriptions;
  std::list<Publication> publications;
  std::optional<Frames> tf;

  const auto open_frames = [&](const Mapping& published) {
    tf.emplace();
    tf->rate = published.rate;
    tf->moving = hc::value_or_end(participant->write(published.topic, hc::ros::Type::TfMessage,
                                                     qos_of(published, hc::ros::Type::TfMessage)));
    tf->fixed =
        hc::value_or_end(participant->write(published.topic + "_static", hc::ros::Type::TfMessage,
                                            {.transient_local = true, .depth = 1}));
    if (joints->fixed.empty()) return;
    if (auto written = tf->fixed.write(tf->encoder.encode(joints->fixed)); !written)
      module.log(published.topic + "_static: " + written.error().detail);
  };
  module.on_start([&] {
    const auto published = hc::value_or_end(parse_publish(*publish));
    const auto subscribed = hc::value_or_end(parse_subscribe(*subscribe));
    if (published.empty() && subscribed.empty())
      throw hc::ModuleError(
          hc::Error{hc::Code::Invalid,
                    "neither publish nor subscribe names a topic: publish=eyes.left=/left"});
    if (!is_node(*node))
      throw hc::ModuleError(hc::Error{
          hc::Code::Invalid, "node: \"" + *node + "\" may contain only letters, digits and _"});
    joints = hc::value_or_end(hc::ros::GraphJoints::read(*frames));
    const std::string release = distro->empty() ? environment("ROS_DISTRO", "") : *distro;
    participant = hc::value_or_end(Participant::open(
        {domain_of(*domain),
         range->empty() ? environment("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST") : *range, *node,
         release == "humble"},
        warn));
    for (const auto& each : subscribed) {
      subscriptions.push_back({each, outputs.at(each.port), RateLimit(each.rate),
                               hc::value_or_end(participant->read(
                                   each.topic, *each.type, qos_of(each, *each.type), wake))});
    }
    const auto graph = hc::own_graph();
    for (const auto& each : published) {
      if (each.port == "frames") {
        open_frames(each);
        continue;
      }
      if (!graph)
        throw hc::ModuleError(
            "HC_GRAPH does not name a running graph, NAME.PID; "
            "run this module in a graph, or add it to one: hc graph add ros2 ros2");
      publications.emplace_back(*graph, each, joints->names, *participant, log);
    }
    arrived.raise();
  });
  module.on_readable([&] { return loop->descriptor(); },
                     [&] { hc::succeed_or_end(loop->turn(std::chrono::milliseconds(0))); });

  const auto take = [&](Subscription& from, const hc::Result<std::span<const std::byte>>& bytes) {
    const auto& subscribed = from.subscribed;
    if (!from.limit.passes(module.monotonic().count())) return;
    auto message = bytes
                       ? hc::ros::decode(*subscribed.type, *bytes, from.to.port, subscribed.choice)
                       : hc::Result<hc::Message>(bytes.error());
    if (message && !message->plain()) message = hc::expand(*message);
    if (!message)
      return module.log_once("refused of " + subscribed.topic,
                             subscribed.topic + ": message refused (further ones are counted): " +
                                 message.error().detail);
    if (message->header.time == 0) message->header.time = module.now();
    message->header.coord = subscribed.coord;
    from.to.send(std::move(*message));
  };
  module.on_readable([&] { return arrived.descriptor(); },
                     [&] {
                       arrived.clear();
                       for (auto& each : subscriptions)
                         each.reader.take([&](const auto& bytes) { take(each, bytes); });
                     });
  module.on(poses, [&](const auto& pose) {
    if (!tf) return;
    const auto joint = joints->joint_of(pose);
    if (!joint) return module.log_once("pose", joint.error().detail);
    auto& limit = tf->limits.try_emplace(joint->child, tf->rate).first->second;
    if (!limit.passes(module.monotonic().count())) return;
    const auto written = tf->moving.write(tf->encoder.encode(std::span(&*joint, 1)));
    if (!written) module.log_once("frames not written", "frames: " + written.error().detail);
  });
  const int status = module.run(argc, argv);
  publications.clear();
  subscriptions.clear();
  tf.reset();
  participant.reset();
  return status;
}
