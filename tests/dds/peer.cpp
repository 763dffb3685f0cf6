// SPDX-License-Identifier: Apache-2.0
// dds_peer write TOPIC FILE …: writes each file as a sample, when there is a reader, and an empty
// one at the end. dds_peer read TOPIC: prints the octets of samples until an empty one. By Cyclone
// DDS alone.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <dds/dds.h>

#include "message.h"

namespace {

dds_entity_t require(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  std::fprintf(stderr, "dds_peer: %s: %s\n", what, dds_strretcode(entity));
  std::exit(1);
}

dds_qos_t* qos() {
  dds_qos_t* made = dds_create_qos();
  dds_qset_reliability(made, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(made, DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(made, 1, &representation);
  return made;
}

/// Waits until an entity has one of these statuses.
void await(dds_entity_t participant, dds_entity_t entity, std::uint32_t status) {
  require(dds_set_status_mask(entity, status), "status");
  const auto waiting = require(dds_create_waitset(participant), "waitset");
  require(dds_waitset_attach(waiting, entity, 0), "waitset");
  require(dds_waitset_wait(waiting, nullptr, 0, DDS_INFINITY), "waitset");
  require(dds_delete(waiting), "waitset");
}

void write(dds_entity_t writer, std::string octets) {
  hypercolumn_Message sample{};
  sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(octets.size());
  sample.bytes._buffer = reinterpret_cast<std::uint8_t*>(octets.data());
  require(dds_write(writer, &sample), "write");
}

/// Takes a sample, and prints it; false: it was empty.
bool print(dds_entity_t participant, dds_entity_t reader) {
  void* sample = nullptr;
  dds_sample_info_t info{};
  while (require(dds_take(reader, &sample, &info, 1, 1), "take") == 0)
    await(participant, reader, DDS_DATA_AVAILABLE_STATUS);
  const auto& bytes = static_cast<const hypercolumn_Message*>(sample)->bytes;
  const bool has_octets = info.valid_data && bytes._length > 0;
  if (has_octets) std::fwrite(bytes._buffer, 1, bytes._length, stdout);
  require(dds_return_loan(reader, &sample, 1), "return");
  return has_octets || !info.valid_data;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const auto participant = require(dds_create_participant(0, nullptr, nullptr), "participant");
  const auto topic = require(
      dds_create_topic(participant, &hypercolumn_Message_desc, argv[2], nullptr, nullptr), "topic");
  if (argv[1] == std::string("read")) {
    const auto reader = require(dds_create_reader(participant, topic, qos(), nullptr), "reader");
    while (print(participant, reader)) continue;
    std::fflush(stdout);
  } else {
    const auto writer = require(dds_create_writer(participant, topic, qos(), nullptr), "writer");
    await(participant, writer, DDS_PUBLICATION_MATCHED_STATUS);
    for (int i = 3; i < argc; ++i) {
      std::ifstream file(argv[i], std::ios::binary);
      write(writer, std::string(std::istreambuf_iterator<char>(file), {}));
    }
    write(writer, "");
    require(dds_wait_for_acks(writer, DDS_INFINITY), "acknowledgement");
  }
  return dds_delete(participant) == 0 ? 0 : 1;
}
