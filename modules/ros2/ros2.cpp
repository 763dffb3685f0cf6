// SPDX-License-Identifier: Apache-2.0
#include "ros2.h"

#include <cstdlib>
#include <utility>

#include <hc/base/text.h>
#include <hc/compress/compress.h>
#include <ros/decode.h>

#include "names.h"

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
  if (!hc::read_number(text, domain)) hc::refuse("ROS_DOMAIN_ID is \"" + text + "\", not a number");
  return domain;
}

}  // namespace

Participant::Options Ros2Parameters::participant() const {
  const std::string release = distro->empty() ? environment("ROS_DISTRO", "") : *distro;
  return {domain_of(*domain),
          range->empty() ? environment("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST") : *range,
          *node, release == "humble"};
}

std::map<std::string, Ros2::Destination> Ros2::add_outputs(hc::Module& module) {
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
  add("joints", hc::table(), "of JointState: a row of positions, then of velocities and efforts");
  add("text", hc::string(), "of String");
  add("numbers", hc::table(), "of Float64MultiArray");
  return outputs;
}

Ros2::Ros2(hc::Module& module)
    : module_(module),
      loop_(hc::value_or_end(hc::Loop::make())),
      arrived_(hc::value_or_end(hc::Event::make())) {
  module.on_start([this] { start(); });
  module.on_readable([this] { return loop_->descriptor(); },
                     [this] { hc::succeed_or_end(loop_->turn(std::chrono::milliseconds(0))); });
  module.on_readable([this] { return arrived_.descriptor(); },
                     [this] {
                       arrived_.clear();
                       for (auto& each : subscriptions_)
                         each.reader.take([&](const auto& bytes) { take(each, bytes); });
                     });
  module.on(poses_, [this](const auto& pose) { write_pose(pose); });
}

void Ros2::start() {
  const auto published = hc::value_or_end(parse_publish(*parameters_.publish));
  const auto subscribed = hc::value_or_end(parse_subscribe(*parameters_.subscribe));
  if (published.empty() && subscribed.empty())
    hc::refuse("neither publish nor subscribe names a topic: publish=eyes.left=/left");
  if (!is_node(*parameters_.node))
    hc::refuse("node: \"" + *parameters_.node + "\" may contain only letters, digits and _");
  joints_ =
      hc::value_or_refuse(parameters_.frames, hc::ros::GraphJoints::read(*parameters_.frames));
  participant_ = hc::value_or_end(Participant::open(parameters_.participant(), warn_));
  for (const auto& each : subscribed) subscribe(each);
  const auto graph = hc::own_graph();
  for (const auto& each : published) publish(each, graph);
  arrived_.raise();
}

void Ros2::subscribe(const Mapping& subscribed) {
  const auto type = *subscribed.type;
  subscriptions_.push_back({subscribed, outputs_.at(subscribed.port), RateLimit(subscribed.rate),
                            hc::value_or_end(participant_->read(subscribed.topic, type,
                                                                qos_of(subscribed, type), wake_))});
}

void Ros2::publish(const Mapping& published, const std::optional<hc::RunningGraph>& graph) {
  if (published.port == "frames") return publish_frames(published);
  if (!graph)
    throw hc::ModuleError(
        "HC_GRAPH does not name a running graph, NAME.PID; "
        "run this module in a graph, or add it to one: hc graph add ros2 ros2");
  publications_.emplace_back(
      *graph, published, joints_->names, *participant_,
      [this](const std::string& kind, const std::string& line) { log(kind, line); });
}

void Ros2::publish_frames(const Mapping& published) {
  transforms_.emplace(*participant_, published);
  if (auto written = transforms_->write_fixed(joints_->fixed); !written)
    module_.log(published.topic + "_static: " + written.error().detail);
}

void Ros2::take(Subscription& from, const Bytes& bytes) {
  const auto& subscribed = from.subscribed;
  if (!from.limit.passes(module_.monotonic())) return;
  auto message = bytes ? hc::ros::decode(*subscribed.type, *bytes, from.to.port, subscribed.choice)
                       : hc::Result<hc::Message>(bytes.error());
  if (message && !message->plain()) message = hc::expand(*message);
  if (!message)
    return module_.log_once("refused of " + subscribed.topic,
                            subscribed.topic + ": message refused (further ones are counted): " +
                                message.error().detail);
  if (message->header.time == hc::Time()) message->header.time = module_.now();
  message->header.coord = subscribed.coord;
  from.to.send(std::move(*message));
}

void Ros2::write_pose(const hc::Message& pose) {
  if (!transforms_) return;
  const auto joint = joints_->joint_of(pose);
  if (!joint) return module_.log_once("pose", joint.error().detail);
  const auto written = transforms_->write(*joint, module_.monotonic());
  if (!written) module_.log_once("frames not written", "frames: " + written.error().detail);
}

void Ros2::log(const std::string& kind, const std::string& line) {
  constexpr int kMostWaiting = 1000;
  if (waiting_ >= kMostWaiting) return;
  ++waiting_;
  loop_->post([this, kind, line] {
    --waiting_;
    module_.log_once(kind, line);
  });
}
