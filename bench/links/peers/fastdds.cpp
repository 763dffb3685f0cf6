// SPDX-License-Identifier: Apache-2.0
// Fast DDS 2.9, reliable and KEEP_ALL, so that the writer waits; discovery over shared memory. Mode
// `datasharing`: plain samples are loaned and written where the reader reads them. Mode `shm`: its
// shared-memory transport, with segments for 8 images. Readers sleep in wait_for_unread_message and
// take one loaned sample. With data sharing a sample counts as read when it is taken, so a fast
// writer overwrites it while it is read, and the harness refuses it.
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <unistd.h>

#include <cstring>
#include <functional>

#include "../harness.h"

namespace {

namespace dds = eprosima::fastdds::dds;
using bench::Setup;
using eprosima::fastrtps::Duration_t;

constexpr int kDomain = 17;
const Duration_t kHeartbeat(0, 1'000'000);  // [ns]
constexpr std::uint32_t kHeadBytes = 4;     // of a serialised payload: how it is encoded

/// Some bytes, of a number that is the same for all samples of a topic.
class Bytes final : public dds::TopicDataType {
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

 public:
  explicit Bytes(std::size_t size) : size_(static_cast<std::uint32_t>(size)) {
    m_typeSize = size_ + kHeadBytes;
    setName(("bytes" + std::to_string(size)).c_str());
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, Payload* payload) override {
    const unsigned char head[kHeadBytes] = {0, 1, 0, 0};  // CDR, little-endian
    std::memcpy(payload->data, head, kHeadBytes);
    std::memcpy(payload->data + kHeadBytes, data, size_);
    payload->encapsulation = CDR_LE;
    payload->length = m_typeSize;
    return true;
  }
  bool deserialize(Payload* payload, void* data) override {
    std::memcpy(data, payload->data + kHeadBytes, size_);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [this] { return m_typeSize; };
  }
  void* createData() override { return new std::byte[size_]; }
  void deleteData(void* data) override { delete[] static_cast<std::byte*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
  [[nodiscard]] bool is_bounded() const override { return true; }
  [[nodiscard]] bool is_plain() const override { return true; }
  bool construct_sample(void*) const override { return true; }

 private:
  std::uint32_t size_;
};

/// A participant and a topic of it.
struct Node {
  explicit Node(const Setup& setup) {
    auto transport = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
    transport->segment_size(static_cast<std::uint32_t>(8 * setup.bytes + (4U << 20)));
    transport->max_message_size(static_cast<std::uint32_t>(setup.bytes + 65536));
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(transport);
    auto* factory = dds::DomainParticipantFactory::get_instance();
    participant = factory->create_participant(kDomain, qos);
    if (participant == nullptr) bench::fail("Fast DDS creates no participant");
    dds::TypeSupport type(new Bytes(setup.bytes));
    type.register_type(participant);
    topic = participant->create_topic(setup.link, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;
  ~Node() {
    participant->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }

  dds::DomainParticipant* participant;
  dds::Topic* topic;
};

template <typename Qos>
Qos with_policies(Qos qos, const Setup& setup) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = Duration_t(10, 0);
  qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
  const int depth = setup.is_small() ? 1000 : setup.mode == "shm" ? 4 : 16;
  qos.resource_limits().max_samples = qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().allocated_samples = depth;
  qos.resource_limits().max_instances = 1;
  if (setup.mode == "datasharing")
    qos.data_sharing().automatic();
  else
    qos.data_sharing().off();
  return qos;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup) : setup_(setup), node_(setup) {
    auto* publisher = node_.participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    auto qos = with_policies(dds::DATAWRITER_QOS_DEFAULT, setup);
    // What a full writer waits for; the default of 3 s would let it fail.
    qos.reliable_writer_qos().times.heartbeatPeriod = kHeartbeat;
    writer_ = publisher->create_datawriter(node_.topic, qos);
    if (writer_ == nullptr) bench::fail("Fast DDS creates no writer");
  }

  void await_readers() override {
    dds::PublicationMatchedStatus matched;
    do {
      ::usleep(1000);
      writer_->get_publication_matched_status(matched);
    } while (matched.current_count < setup_.readers);
  }

  std::span<std::byte> loan() override {
    // There is nothing to lend while all samples are on their way.
    for (bench::Spin spin; writer_->loan_sample(sample_) != ReturnCode_t::RETCODE_OK;) spin();
    return {static_cast<std::byte*>(sample_), setup_.bytes};
  }

  void publish() override {
    if (!writer_->write(sample_)) bench::fail("Fast DDS writes not");
  }

 private:
  Setup setup_;
  Node node_;
  dds::DataWriter* writer_;
  void* sample_ = nullptr;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup) : bytes_(setup.bytes), node_(setup) {
    auto* subscriber = node_.participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    auto qos = with_policies(dds::DATAREADER_QOS_DEFAULT, setup);
    qos.reliable_reader_qos().times.heartbeatResponseDelay = Duration_t(0, 0);
    reader_ = subscriber->create_datareader(node_.topic, qos);
    if (reader_ == nullptr) bench::fail("Fast DDS creates no reader");
  }

  void await_writer() override {
    dds::SubscriptionMatchedStatus matched;
    do {
      ::usleep(1000);
      reader_->get_subscription_matched_status(matched);
    } while (matched.current_count == 0);
  }

  std::span<const std::byte> receive() override {
    while (true) {
      if (samples_.length() > 0) reader_->return_loan(samples_, infos_);
      auto taken = reader_->take(samples_, infos_, 1);
      if (taken == ReturnCode_t::RETCODE_OK && infos_[0].valid_data) return {&samples_[0], bytes_};
      if (taken != ReturnCode_t::RETCODE_OK) reader_->wait_for_unread_message(Duration_t(1, 0));
    }
  }

 private:
  std::size_t bytes_;
  Node node_;
  dds::DataReader* reader_;
  dds::LoanableSequence<std::byte> samples_;  // pointers to the first bytes
  dds::SampleInfoSeq infos_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
