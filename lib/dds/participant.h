// SPDX-License-Identifier: Apache-2.0
#pragma once
// The participant of one end of a DDS link, with one topic. Internal.
// Each has its own threads and sockets of Cyclone DDS, so that a slow reader stalls no other.

#include <memory>
#include <vector>

#include <dds/dds.h>

#include <dds/entity.h>
#include <dds/place.h>
#include <dds/sample.h>
#include <hc/link/link.h>
#include <hc/link/stream/remarks.h>
#include <hc/os/event.h>
#include <hc/os/reactor.h>

namespace hc::dds {

/// Reliable, without history for late readers; messages are dropped only by a link's policy.
QosOwner make_qos();

class Participant {
 public:
  /// Errors: NotFound (this host has no such address), System.
  static Result<std::unique_ptr<Participant>> open(const Place& place, const Limits& limits);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] dds_entity_t handle() const { return participant_.handle(); }
  [[nodiscard]] dds_entity_t topic() const { return topic_.handle(); }
  [[nodiscard]] const ddsi_sertype& type() const { return *type_; }

  /// Queues a line for flush_log(). May be called on any thread.
  void warn(std::string line) { remarks_->add(std::move(line)); }
  void flush_log(const LogSink& log) { remarks_->flush(log); }

 private:
  explicit Participant(std::uint32_t number);
  /// Drops packets that arrive on other interfaces.
  [[nodiscard]] Status drop_other_interfaces(const std::vector<unsigned>& interfaces) const;

  std::uint32_t number_;  // of the domain, in this process
  std::shared_ptr<internal::Remarks> remarks_;
  Entity domain_, participant_, topic_;
  const ddsi_sertype* type_ = nullptr;
};

/// Opens a participant once this host has the addresses of its place, which may come up after the
/// programs have started.
class Entrance {
 public:
  /// @param event  raised when it is time to call open() again; outlives this.
  Status begin(Place place, const Event& event);
  /// The participant; null while an address is missing, which is logged once. Errors: System.
  Result<std::unique_ptr<Participant>> open(const LinkOptions& options);
  /// Why open() gave null. Errors: NotFound.
  [[nodiscard]] const Error& missing() const { return *missing_; }

 private:
  Place place_;
  std::optional<Error> missing_;
  Watch::TimePoint next_;
  Watch timer_;
};

}  // namespace hc::dds
