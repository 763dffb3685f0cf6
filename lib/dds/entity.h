// SPDX-License-Identifier: Apache-2.0
#pragma once
// Owners of objects of Cyclone DDS. Internal.

#include <memory>
#include <string>
#include <utility>

#include <dds/dds.h>

#include <hc/base/result.h>

namespace hc::dds {

/// Owns a DDS entity.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    const dds_entity_t handle = std::exchange(other.handle_, 0);
    reset();
    handle_ = handle;
    return *this;
  }
  ~Entity() { reset(); }
  void reset() {
    if (handle_ > 0) dds_delete(handle_);
    handle_ = 0;
  }
  [[nodiscard]] dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

struct QosDelete {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosOwner = std::unique_ptr<dds_qos_t, QosDelete>;

struct ListenerDelete {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};
using ListenerOwner = std::unique_ptr<dds_listener_t, ListenerDelete>;

/// "writer: Cyclone DDS: Out of resources"
inline Error failed(const std::string& what, dds_return_t code) {
  return {Code::System, what + ": Cyclone DDS: " + dds_strretcode(code)};
}

}  // namespace hc::dds
