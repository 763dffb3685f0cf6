// SPDX-License-Identifier: Apache-2.0
// cyclone_peer: sends each type on /peer/TYPE ten times a second, and says what it got on /hc/TYPE
// and of ros_discovery_info, and who publishes what. By Cyclone DDS, types compiled by idlc. Until
// its standard input ends.

#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

#include <dds/dds.h>

#include "samples.h"

namespace {

dds_qos_t* qos(bool reliable) {
  dds_qos_t* made = dds_create_qos();
  dds_qset_reliability(made, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_SECS(1));
  dds_qset_history(made, DDS_HISTORY_KEEP_LAST, 10);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(made, 1, &representation);
  return made;
}

/// Takes all, and calls a function with each.
template <typename T, typename F>
void take(dds_entity_t reader, F each) {
  void* samples[16] = {};
  dds_sample_info_t infos[16];
  const auto count = dds_take(reader, samples, infos, 16, 16);
  for (dds_return_t i = 0; i < count; ++i)
    if (infos[i].valid_data) each(*static_cast<T*>(samples[i]));
  if (count > 0) dds_return_loan(reader, samples, count);
}

template <typename T>
struct TopicOf : Topic {
  TopicOf(dds_entity_t participant, const dds_topic_descriptor_t& type, std::string called)
      : name(std::move(called)) {
    const auto there =
        dds_create_topic(participant, &type, ("rt/peer/" + name).c_str(), nullptr, nullptr);
    const auto back =
        dds_create_topic(participant, &type, ("rt/hc/" + name).c_str(), nullptr, nullptr);
    writer = dds_create_writer(participant, there, qos(true), nullptr);
    reader = dds_create_reader(participant, back, qos(false), nullptr);
    Fill fill;
    visit(fill, sample);
  }
  void write() override {
    if (dds_write(writer, &sample) < 0) say(name + ": not written");
  }
  void read() override {
    take<T>(reader, [&](T& got) { say_whether_right(name, got); });
  }

  std::string name;
  T sample{};
  dds_entity_t writer = 0, reader = 0;
};

std::string user_data(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  std::string text;
  if (dds_qget_userdata(qos, &data, &size) && data != nullptr)
    text.assign(static_cast<const char*>(data), size);
  dds_free(data);
  return text;
}

}  // namespace

int main() {
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  const auto participant =
      dds_create_participant(static_cast<dds_domainid_t>(std::atoi(domain)), nullptr, nullptr);
  if (participant < 0) return 1;
  std::vector<std::unique_ptr<Topic>> topics;
#define ADD(package, name)                                         \
  topics.push_back(std::make_unique<TopicOf<TYPE(package, name)>>( \
      participant, package##_msg_dds__##name##__desc, #name));
  FOR_EACH_TYPE(ADD)
  using Info = TYPE(rmw_dds_common, ParticipantEntitiesInfo);
  auto* late = qos(true);
  dds_qset_history(late, DDS_HISTORY_KEEP_ALL, 0);  // a node announces each of its ends
  dds_qset_durability(late, DDS_DURABILITY_TRANSIENT_LOCAL);
  const auto info_topic =
      dds_create_topic(participant, &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
                       "ros_discovery_info", nullptr, nullptr);
  const auto infos = dds_create_reader(participant, info_topic, late, nullptr);
  using Tf = TYPE(tf2_msgs, TFMessage);
  const auto static_topic = dds_create_topic(participant, &tf2_msgs_msg_dds__TFMessage__desc,
                                             "rt/hc/TFMessage_static", nullptr, nullptr);
  const auto fixed = dds_create_reader(participant, static_topic, late, nullptr);
  const auto publications =
      dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  const auto participants =
      dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
  pollfd end = {STDIN_FILENO, POLLIN, 0};
  while (::poll(&end, 1, 100) == 0) {
    for (auto& topic : topics) {
      topic->write();
      topic->read();
    }
    take<Info>(infos, [](const Info& info) {
      for (std::uint32_t i = 0; i < info.node_entities_info_seq._length; ++i) {
        const auto& node = info.node_entities_info_seq._buffer[i];
        say(std::string("node ") + node.node_namespace + node.node_name + " reads " +
            std::to_string(node.reader_gid_seq._length) + " writes " +
            std::to_string(node.writer_gid_seq._length));
      }
    });
    take<Tf>(fixed, [](const Tf& tf) {
      for (std::uint32_t i = 0; i < tf.transforms._length; ++i)
        say(std::string("static ") + tf.transforms._buffer[i].header.frame_id + " " +
            tf.transforms._buffer[i].child_frame_id);
    });
    take<dds_builtintopic_endpoint_t>(publications, [](const dds_builtintopic_endpoint_t& each) {
      say(std::string("publication ") + each.topic_name + " " + each.type_name + " " +
          user_data(each.qos));
    });
    take<dds_builtintopic_participant_t>(participants,
                                         [](const dds_builtintopic_participant_t& each) {
                                           say("participant " + user_data(each.qos));
                                         });
  }
  dds_delete(participant);
  return 0;
}
