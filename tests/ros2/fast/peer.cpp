// SPDX-License-Identifier: Apache-2.0
// fast_peer: what cyclone_peer does with the types, by Fast DDS, types compiled by fastddsgen, with
// the settings of participants, writers and readers that ROS has.

#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#if __has_include(<fastdds/utils/IPLocator.hpp>)
#define FAST_DDS 3
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#else
#define FAST_DDS 2
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#endif

#include "samples.h"

namespace fast = eprosima::fastdds::dds;

namespace {

#if FAST_DDS == 3
using Locator = eprosima::fastdds::rtps::Locator_t;
using eprosima::fastdds::rtps::IPLocator;
bool is_ok(fast::ReturnCode_t code) {
  return code == fast::RETCODE_OK;
}
#else
using Locator = eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::IPLocator;
bool is_ok(ReturnCode_t code) {
  return code == ReturnCode_t::RETCODE_OK;
}
#endif

struct Ends {
  fast::DomainParticipant* participant;
  fast::Publisher* publisher;
  fast::Subscriber* subscriber;

  template <typename Support>
  std::string register_type() {
    fast::TypeSupport type(new Support);
#if FAST_DDS == 2
    type->auto_fill_type_object(false);  // as rmw_fastrtps does
    type->auto_fill_type_information(false);
#endif
    type.register_type(participant);
    return type.get_type_name();
  }
  fast::DataReader* reader(const std::string& name, const std::string& type, bool is_late) {
    auto* topic = participant->create_topic(name, type, fast::TOPIC_QOS_DEFAULT);
    fast::DataReaderQos qos;
    qos.history().depth = 10;
    if (is_late) {
      qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;  // a node announces each of its ends
      qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
      qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
    }
    return subscriber->create_datareader(topic, qos);
  }
};

template <typename T, typename F>
void take(fast::DataReader* reader, F each) {
  T sample;
  fast::SampleInfo info;
  while (is_ok(reader->take_next_sample(&sample, &info)))
    if (info.valid_data) each(sample);
}

template <typename T, typename Support>
struct TopicOf : Topic {
  TopicOf(Ends& ends, std::string called) : name(std::move(called)) {
    const std::string type = ends.register_type<Support>();
    auto* there = ends.participant->create_topic("rt/peer/" + name, type, fast::TOPIC_QOS_DEFAULT);
    fast::DataWriterQos qos;
    qos.history().depth = 10;
    writer = ends.publisher->create_datawriter(there, qos);
    reader = ends.reader("rt/hc/" + name, type, false);
    Fill fill;
    visit(fill, sample);
  }
  void write() override {
    if (!is_ok(writer->write(&sample, fast::HANDLE_NIL))) say(name + ": not written");
  }
  void read() override {
    take<T>(reader, [&](T& got) { say_whether_right(name, got); });
  }

  std::string name;
  T sample;
  fast::DataWriter* writer;
  fast::DataReader* reader;
};

}  // namespace

int main() {
  const auto domain = static_cast<std::uint32_t>(std::atoi(std::getenv("ROS_DOMAIN_ID")));
  auto* factory = fast::DomainParticipantFactory::get_instance();
  fast::DomainParticipantQos qos;
  const std::string enclave = "enclave=/;";
  qos.user_data().resize(enclave.size());
  qos.user_data().setValue({enclave.begin(), enclave.end()});
  // As rmw_fastrtps does where discovery is by this machine alone.
  auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->maxInitialPeersRange = 32;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  Locator here;
  IPLocator::setIPv4(here, 127, 0, 0, 1);
  qos.wire_protocol().builtin.initialPeersList.push_back(here);
  Ends ends{factory->create_participant(domain, qos), nullptr, nullptr};
  if (ends.participant == nullptr) return 1;
  ends.publisher = ends.participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
  ends.subscriber = ends.participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  std::vector<std::unique_ptr<Topic>> topics;
#define ADD(package, name)                                                                   \
  topics.push_back(                                                                          \
      std::make_unique<TopicOf<TYPE(package, name), package::msg::dds_::name##_PubSubType>>( \
          ends, #name));
  FOR_EACH_TYPE(ADD)
  using Info = TYPE(rmw_dds_common, ParticipantEntitiesInfo);
  using Tf = TYPE(tf2_msgs, TFMessage);
  auto* infos = ends.reader(
      "ros_discovery_info",
      ends.register_type<rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_PubSubType>(), true);
  auto* fixed = ends.reader("rt/hc/TFMessage_static",
                            ends.register_type<tf2_msgs::msg::dds_::TFMessage_PubSubType>(), true);
  pollfd end = {STDIN_FILENO, POLLIN, 0};
  while (::poll(&end, 1, 100) == 0) {
    for (auto& topic : topics) {
      topic->write();
      topic->read();
    }
    take<Info>(infos, [](const Info& info) {
      for (const auto& node : info.node_entities_info_seq())
        say("node " + std::string(node.node_namespace().c_str()) + node.node_name().c_str() +
            " reads " + std::to_string(node.reader_gid_seq().size()) + " writes " +
            std::to_string(node.writer_gid_seq().size()));
    });
    take<Tf>(fixed, [](const Tf& tf) {
      for (const auto& each : tf.transforms())
        say("static " + each.header().frame_id() + " " + each.child_frame_id());
    });
  }
  ends.participant->delete_contained_entities();
  factory->delete_participant(ends.participant);
  return 0;
}
