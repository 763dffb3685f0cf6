// SPDX-License-Identifier: Apache-2.0
// Cyclone DDS, reliable; scripts/bench_links gives its configuration. Mode `shm`: samples are lent
// through iceoryx, which it does for KEEP_LAST only, here as deep as it allows. Mode `udp`:
// loopback, KEEP_ALL, so that the writer waits. Readers sleep in a WaitSet and take one loaned
// sample.
#include <dds/dds.h>
#include <dds/ddsc/dds_loan_api.h>
#include <unistd.h>

#include <vector>

#include "../harness.h"
#include "cyclone.h"

namespace {

using bench::Setup;

dds_entity_t good(dds_entity_t status, const char* what) {
  if (status < 0) bench::fail(std::string(what) + ": " + dds_strretcode(status));
  return status;
}

dds_entity_t participant() {
  static const dds_entity_t one = good(dds_create_participant(0, nullptr, nullptr), "participant");
  return one;
}

dds_entity_t topic_of(const Setup& setup) {
  const auto* type = setup.bytes == sizeof(bench_dds_Small)    ? &bench_dds_Small_desc
                     : setup.bytes == sizeof(bench_dds_Medium) ? &bench_dds_Medium_desc
                                                               : &bench_dds_Large_desc;
  return good(dds_create_topic(participant(), type, setup.link.c_str(), nullptr, nullptr), "topic");
}

dds_qos_t* qos_of(const Setup& setup) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(10));
  const std::int32_t depth = setup.is_small() ? 256 : 4;
  if (setup.mode == "shm") {
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, setup.is_small() ? 16 : depth);
  } else {
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    dds_qset_resource_limits(qos, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  return qos;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup)
      : setup_(setup),
        writer_(good(dds_create_writer(participant(), topic_of(setup), qos_of(setup), nullptr),
                     "writer")),
        own_(setup.bytes) {}

  void await_readers() override {
    dds_publication_matched_status_t matched{};
    while (dds_get_publication_matched_status(writer_, &matched) == 0 &&
           static_cast<int>(matched.current_count) < setup_.readers)
      ::usleep(1000);
    if (setup_.mode == "shm" && !dds_is_loan_available(writer_)) bench::fail("Cyclone lends none");
  }

  std::span<std::byte> loan() override {
    sample_ = own_.data();
    if (dds_is_loan_available(writer_)) good(dds_loan_sample(writer_, &sample_), "dds_loan_sample");
    return {static_cast<std::byte*>(sample_), setup_.bytes};
  }

  void publish() override { good(dds_write(writer_, sample_), "dds_write"); }

 private:
  Setup setup_;
  dds_entity_t writer_;
  std::vector<std::byte> own_;
  void* sample_ = nullptr;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup)
      : bytes_(setup.bytes),
        reader_(good(dds_create_reader(participant(), topic_of(setup), qos_of(setup), nullptr),
                     "reader")),
        wait_set_(good(dds_create_waitset(participant()), "waitset")) {
    dds_entity_t condition = good(dds_create_readcondition(reader_, DDS_ANY_STATE), "condition");
    good(dds_waitset_attach(wait_set_, condition, reader_), "attach");
  }

  void await_writer() override {
    dds_subscription_matched_status_t matched{};
    while (dds_get_subscription_matched_status(reader_, &matched) == 0 &&
           matched.current_count == 0)
      ::usleep(1000);
  }

  std::span<const std::byte> receive() override {
    if (sample_ != nullptr) good(dds_return_loan(reader_, &sample_, 1), "dds_return_loan");
    sample_ = nullptr;
    dds_sample_info_t info{};
    while (good(dds_take(reader_, &sample_, &info, 1, 1), "dds_take") == 0 || !info.valid_data) {
      if (sample_ != nullptr) good(dds_return_loan(reader_, &sample_, 1), "dds_return_loan");
      sample_ = nullptr;
      good(dds_waitset_wait(wait_set_, nullptr, 0, DDS_INFINITY), "dds_waitset_wait");
    }
    return {static_cast<const std::byte*>(sample_), bytes_};
  }

 private:
  std::size_t bytes_;
  dds_entity_t reader_, wait_set_;
  void* sample_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
  int result = bench::run<Publisher, Subscriber>(argc, argv);
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return result;
}
