// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module on another host, seen from this one: what it says comes out of a pipe, what it reports
// goes to who listens to it here, and what that has to say goes there. Internal.

#include <functional>
#include <memory>
#include <string>

#include <graph/run/module_process.h>
#include <hc/link/intake.h>
#include <hc/link/link.h>
#include <hc/os/event.h>
#include <hc/os/loop.h>

namespace hc::hosts {

class RemoteModule {
 public:
  /// @param manage, control  URIs where it is listened to here; `control` may be empty.
  /// Errors: System.
  static Result<std::shared_ptr<RemoteModule>> make(std::int64_t number, const std::string& manage,
                                                    const std::string& control);

  void said(std::string_view bytes) const;
  void reported(const Message& message);
  /// It listens to commands: what comes is handed to `command`.
  void listens(internal::Loop& loop, std::function<void(const Message& message)> command);
  void started(pid_t process) { process_ = process; }
  void used(const internal::Usage& usage) { usage_ = usage; }
  /// Once; what it has reported has been taken then.
  void ended(int status);

  [[nodiscard]] std::int64_t number() const { return number_; }
  [[nodiscard]] pid_t process() const { return process_; }
  [[nodiscard]] int output() const { return output_.get(); }
  [[nodiscard]] int has_ended() const { return has_ended_.descriptor(); }
  [[nodiscard]] std::optional<int> status() const {
    return status_ < 0 ? std::optional<int>() : status_;
  }
  [[nodiscard]] internal::Usage usage() const { return usage_; }

 private:
  explicit RemoteModule(std::int64_t number) : number_(number) {}

  const std::int64_t number_;
  internal::Descriptor output_, says_;  // a pipe
  internal::Event has_ended_;
  std::string control_;
  int status_ = -1;
  pid_t process_ = 0;
  internal::Usage usage_;
  std::unique_ptr<Sink> reports_;
  std::unique_ptr<internal::Intake> commands_;
};

}  // namespace hc::hosts
