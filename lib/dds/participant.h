// SPDX-License-Identifier: Apache-2.0
#pragma once
// One end of a DDS link in the network: a participant of its own with one topic. Internal.
// Cyclone DDS has threads and sockets for each, so that a reader who takes nothing stalls no other.

#include <memory>
#include <vector>

#include <dds/dds.h>

#include <dds/entity.h>
#include <dds/place.h>
#include <dds/sample.h>
#include <hc/link/link.h>
#include <hc/link/stream/remarks.h>

namespace hc::dds {

/// Reliable, and nothing is kept for who comes later; no message gives way to another but where a
/// link's policy says so.
QosOwner make_qos();

class Participant {
 public:
  /// Errors: NotFound (no such interface), System.
  static Result<std::unique_ptr<Participant>> open(const Place& place, const Limits& limits);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] dds_entity_t handle() const { return participant_.handle(); }
  [[nodiscard]] dds_entity_t topic() const { return topic_.handle(); }
  [[nodiscard]] const ddsi_sertype& type() const { return *type_; }

  /// Has flush_log() log a line; from any thread.
  void warn(std::string line) { remarks_->add(std::move(line)); }
  /// Logs what there is to warn of.
  void flush_log(const LogSink& log) { remarks_->flush(log); }

 private:
  explicit Participant(std::uint32_t number);
  /// Has what comes in by any other interface thrown away.
  [[nodiscard]] Status bar_others(const std::vector<unsigned>& interfaces) const;

  std::uint32_t number_;  // of the domain, in this process
  std::shared_ptr<internal::Remarks> remarks_;
  Entity domain_, participant_, topic_;
  const ddsi_sertype* type_ = nullptr;
};

}  // namespace hc::dds
