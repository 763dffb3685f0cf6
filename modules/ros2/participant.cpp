// SPDX-License-Identifier: Apache-2.0
#include "participant.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include <dds/ddsrt/log.h>

#include "blob.h"
#include "names.h"

namespace {

constexpr std::uint32_t kLastDomain = 232;  // limited by port numbers
constexpr std::size_t kSmall = std::size_t{1} << 20, kLarge = std::size_t{64} << 20;  // [byte]

// rmw_dds_common/msg: an id has 16 bytes, before ROS Iron 24.
template <std::size_t kSize>
using Id = std::array<std::uint8_t, kSize>;

template <std::size_t kSize>
struct NodeEntities {
  std::string node_namespace, node_name;
  std::vector<Id<kSize>> readers, writers;
  static auto members(auto& m) {
    return std::tie(m.node_namespace, m.node_name, m.readers, m.writers);
  }
};

template <std::size_t kSize>
struct ParticipantEntities {
  Id<kSize> id{};
  std::vector<NodeEntities<kSize>> nodes;
  static auto members(auto& m) { return std::tie(m.id, m.nodes); }
};

template <std::size_t kSize>
Id<kSize> id_of(const dds_guid_t& guid) {
  Id<kSize> id{};
  std::ranges::copy(guid.v, id.begin());
  return id;
}

dds_guid_t guid_of(dds_entity_t entity) {
  dds_guid_t guid{};
  static_cast<void>(dds_get_guid(entity, &guid));
  return guid;
}

hc::dds::QosOwner make_qos(const Qos& qos, std::string_view hash) {
  hc::dds::QosOwner made(dds_create_qos());
  auto* to = made.get();
  constexpr dds_duration_t kBlocking = DDS_MSECS(100);
  dds_qset_reliability(to, qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kBlocking);
  dds_qset_history(to, DDS_HISTORY_KEEP_LAST, qos.depth);
  if (qos.transient_local) {
    dds_qset_durability(to, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(to, 0, DDS_HISTORY_KEEP_LAST, qos.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  dds_qset_writer_data_lifecycle(to, false);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(to, 1, &representation);
  if (!hash.empty()) {
    const std::string data = "typehash=RIHS01_" + std::string(hash) + ";";
    dds_qset_userdata(to, data.data(), data.size());
  }
  return made;
}

std::size_t max_bytes(std::string_view type) {
  for (const char* large : {"::Image_", "::CompressedImage_", "::PointCloud2_", "MultiArray_"})
    if (type.ends_with(large)) return kLarge;
  return kSmall;
}

/// Creates a topic; returns it with Cyclone's type object.
hc::Result<std::pair<hc::dds::Entity, const ddsi_sertype*>> open_topic(dds_entity_t participant,
                                                                       const std::string& name,
                                                                       const std::string& type) {
  auto* sertype = make_blob_type(type, max_bytes(type));
  const auto topic =
      dds_create_topic_sertype(participant, name.c_str(), &sertype, nullptr, nullptr, nullptr);
  if (topic < 0) {
    ddsi_sertype_unref(sertype);
    return hc::dds::failed("topic " + name, topic);
  }
  return std::pair<hc::dds::Entity, const ddsi_sertype*>{hc::dds::Entity(topic), sertype};
}

void hand_over(void* log, const dds_log_data_t* data) {
  std::string_view line(data->message, data->size);
  while (line.ends_with('\n')) line.remove_suffix(1);
  (*static_cast<const std::function<void(std::string_view)>*>(log))(line);
}

}  // namespace

std::string configuration(std::string_view range) {
  const std::string limits =
      "<Internal><MaxSampleSize>" + std::to_string(kLarge) + " B</MaxSampleSize></Internal>";
  const std::string loopback =
      "<General><AllowMulticast>false</AllowMulticast><Interfaces>"
      "<NetworkInterface address=\"127.0.0.1\"/></Interfaces></General>";
  // 32 participants on a machine, as in ROS.
  const std::string many =
      "<ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>";
  if (range == "LOCALHOST")
    return limits + loopback + "<Discovery>" + many +
           "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>";
  if (range == "OFF")
    return limits + loopback + "<Discovery>" + many + "<Tag>hypercolumn_" +
           std::to_string(::getpid()) + "</Tag></Discovery>";
  if (range == "SUBNET" || range == "SYSTEM_DEFAULT")
    return limits + "<Discovery>" + many + "</Discovery>";
  return "";
}

hc::Status Writer::write(const hc::ros::Pieces& pieces) {
  const auto written = dds_writecdr(writer_.handle(), make_blob(*type_, pieces));
  if (written == DDS_RETCODE_TIMEOUT)
    return hc::Error{hc::Code::System, "a subscriber is too slow"};
  if (written != DDS_RETCODE_OK) return hc::dds::failed("written", written);
  return {};
}

void Reader::take(const Take& take) {
  constexpr std::uint32_t kMany = 16;
  std::array<ddsi_serdata*, kMany> blobs{};
  std::array<dds_sample_info_t, kMany> infos{};
  for (std::int32_t left = depth_; left > 0; left -= kMany) {
    const auto wanted = std::min<std::uint32_t>(kMany, static_cast<std::uint32_t>(left));
    const auto count =
        dds_takecdr(reader_.handle(), blobs.data(), wanted, infos.data(), DDS_ANY_STATE);
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) {
        if (is_too_large(*blobs[i]))
          take(hc::Error{hc::Code::TooLarge, "larger than the limit for its type"});
        else
          take(bytes_of(*blobs[i]));
      }
      ddsi_serdata_unref(blobs[i]);
    }
    if (count < static_cast<dds_return_t>(wanted)) return;
  }
}

hc::Result<std::unique_ptr<Participant>> Participant::open(
    const Options& options, const std::function<void(std::string_view)>& log) {
  const std::string config = configuration(options.range);
  if (config.empty())
    return hc::Error{hc::Code::Invalid, "\"" + options.range +
                                            "\" is not one of LOCALHOST, SUBNET, "
                                            "SYSTEM_DEFAULT, OFF"};
  if (options.domain > kLastDomain)
    return hc::Error{hc::Code::Invalid, "domain " + std::to_string(options.domain) +
                                            " is not in 0 to " + std::to_string(kLastDomain)};
  dds_set_log_sink(hand_over, const_cast<std::function<void(std::string_view)>*>(&log));
  std::unique_ptr<Participant> made(new Participant);
  made->options_ = options;
  const auto domain = dds_create_domain(options.domain, config.c_str());
  if (domain < 0) return hc::dds::failed("domain " + std::to_string(options.domain), domain);
  made->domain_ = hc::dds::Entity(domain);
  const hc::dds::QosOwner qos(dds_create_qos());
  constexpr std::string_view kEnclave = "enclave=/;";
  dds_qset_userdata(qos.get(), kEnclave.data(), kEnclave.size());
  const auto participant = dds_create_participant(options.domain, qos.get(), nullptr);
  if (participant < 0)
    return hc::dds::failed(
        "no participant of domain " + std::to_string(options.domain) + " (33 per machine)",
        participant);
  made->participant_ = hc::dds::Entity(participant);
  auto discovery = made->open_writer("ros_discovery_info",
                                     dds_type("rmw_dds_common/msg/ParticipantEntitiesInfo"),
                                     kDiscoveryHash, {.transient_local = true, .depth = 1});
  if (!discovery) return discovery.error();
  made->discovery_ = std::move(*discovery);
  if (auto announced = made->announce(); !announced) return announced.error();
  return made;
}

Participant::~Participant() {
  discovery_ = {};
  participant_ = {};
  domain_ = {};
  dds_set_log_sink(nullptr, nullptr);
}

hc::Result<Writer> Participant::open_writer(const std::string& topic, const std::string& type,
                                            std::string_view hash, const Qos& qos) {
  const auto settings = make_qos(qos, options_.is_humble ? "" : hash);
  auto opened = open_topic(participant_.handle(), topic, type);
  if (!opened) return opened.error();
  Writer made;
  std::tie(made.topic_, made.type_) = std::move(*opened);
  const auto writer =
      dds_create_writer(participant_.handle(), made.topic_.handle(), settings.get(), nullptr);
  if (writer < 0) return hc::dds::failed("writer of " + topic, writer);
  made.writer_ = hc::dds::Entity(writer);
  return made;
}

hc::Result<Writer> Participant::write(const std::string& topic, hc::ros::Type type,
                                      const Qos& qos) {
  auto made =
      open_writer(dds_topic(topic), dds_type(hc::ros::schema(type).name), hash_of(type), qos);
  if (!made) return made;
  if (auto announced = announce(&writers_, made->writer_.handle()); !announced)
    return announced.error();
  return made;
}

hc::Result<Reader> Participant::read(const std::string& topic, hc::ros::Type type, const Qos& qos,
                                     const std::function<void()>& arrived) {
  const auto settings = make_qos(qos, options_.is_humble ? "" : hash_of(type));
  dds_qset_ignorelocal(settings.get(), DDS_IGNORELOCAL_PARTICIPANT);
  auto opened =
      open_topic(participant_.handle(), dds_topic(topic), dds_type(hc::ros::schema(type).name));
  if (!opened) return opened.error();
  Reader made;
  made.depth_ = qos.depth;
  made.topic_ = std::move(opened->first);
  const hc::dds::ListenerOwner listener(
      dds_create_listener(const_cast<std::function<void()>*>(&arrived)));
  dds_lset_data_available(listener.get(), [](dds_entity_t, void* call) {
    (*static_cast<const std::function<void()>*>(call))();
  });
  const auto reader = dds_create_reader(participant_.handle(), made.topic_.handle(), settings.get(),
                                        listener.get());
  if (reader < 0) return hc::dds::failed("reader of " + topic, reader);
  made.reader_ = hc::dds::Entity(reader);
  if (auto announced = announce(&readers_, reader); !announced) return announced.error();
  return made;
}

hc::Status Participant::announce(std::vector<dds_guid_t>* list, dds_entity_t added) {
  const auto write = [&]<std::size_t kSize>(std::integral_constant<std::size_t, kSize>) {
    ParticipantEntities<kSize> info{id_of<kSize>(guid_of(participant_.handle())),
                                    {{"/", options_.node, {}, {}}}};
    for (const auto& guid : readers_) info.nodes[0].readers.push_back(id_of<kSize>(guid));
    for (const auto& guid : writers_) info.nodes[0].writers.push_back(id_of<kSize>(guid));
    hc::ros::CdrWriter writer;
    return discovery_.write(writer.write(info));
  };
  const std::lock_guard lock(mutex_);
  if (list != nullptr) list->push_back(guid_of(added));
  if (options_.is_humble) return write(std::integral_constant<std::size_t, 24>{});
  return write(std::integral_constant<std::size_t, 16>{});
}
