// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: a writer of arbitrary samples to a topic, and a reader that counts samples.

#include <memory>
#include <string>
#include <string_view>

#include <dds/participant.h>
#include <hc/testing/link_conformance.h>

namespace hc::testing {

inline std::span<const std::byte> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

class Stranger {
 public:
  explicit Stranger(const std::string& uri)
      : participant_(std::move(*dds::Participant::open(*dds::parse_place(*parse_uri(uri)), {}))) {
    const auto qos = dds::make_qos();
    writer_ = dds::Entity(
        dds_create_writer(participant_->handle(), participant_->topic(), qos.get(), nullptr));
    EXPECT_GT(writer_.handle(), 0);
    while (!has_reader()) std::this_thread::yield();
  }

  /// A sequence of octets.
  void send(std::string_view octets) {
    write(dds::make_sample(participant_->type(), {bytes_of(octets), {}, {}}, {}));
  }
  /// All bytes of a sample.
  void send_raw(std::string_view bytes) {
    const ddsrt_iovec_t piece = {const_cast<char*>(bytes.data()), bytes.size()};
    write(dds::Sample(
        ddsi_serdata_from_ser_iov(&participant_->type(), SDK_DATA, 1, &piece, bytes.size())));
  }

 private:
  [[nodiscard]] bool has_reader() const {
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(writer_.handle(), &status) == DDS_RETCODE_OK &&
           status.current_count > 0;
  }
  void write(dds::Sample sample) {
    while (dds_writecdr(writer_.handle(), ddsi_serdata_ref(sample.get())) == DDS_RETCODE_TIMEOUT)
      dds_wait_for_acks(writer_.handle(), DDS_INFINITY);
  }

  std::unique_ptr<dds::Participant> participant_;
  dds::Entity writer_;
};

class SampleCounter {
 public:
  explicit SampleCounter(const std::string& uri)
      : participant_(std::move(*dds::Participant::open(*dds::parse_place(*parse_uri(uri)), {}))) {
    const auto qos = dds::make_qos();
    reader_ = dds::Entity(
        dds_create_reader(participant_->handle(), participant_->topic(), qos.get(), nullptr));
    EXPECT_GT(reader_.handle(), 0);
  }

  /// The number of samples with messages before the writer closes.
  int count() {
    for (int count = 0;;) {
      ddsi_serdata* taken = nullptr;
      dds_sample_info_t info{};
      const auto got = dds_takecdr(reader_.handle(), &taken, 1, &info, DDS_ANY_STATE);
      if (got < 0) return got;
      if (got == 0) {
        std::this_thread::yield();
        continue;
      }
      const dds::Sample sample(taken);
      if (!info.valid_data) continue;
      if (dds::octets_of(*sample) == 0) return count;
      ++count;
    }
  }

 private:
  std::unique_ptr<dds::Participant> participant_;
  dds::Entity reader_;
};

}  // namespace hc::testing
