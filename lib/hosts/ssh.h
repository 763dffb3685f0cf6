// SPDX-License-Identifier: Apache-2.0
#pragma once
// ssh, which runs the agent on a host and carries the conversation with it. Internal.

#include <memory>
#include <string>
#include <utility>

#include <graph/hosts.h>
#include <graph/process.h>
#include <hosts/conversation.h>

namespace hc::hosts {

/// Used on the thread of a loop.
class Ssh {
 public:
  /// Errors: System.
  static Result<std::unique_ptr<Ssh>> start(Loop& loop, const GraphHost& host,
                                            Conversation::Callbacks callbacks);

  void send(const Message& message) { conversation_->send(message); }
  /// Stops taking and sending messages.
  void close() { conversation_->close(); }

  /// The first message of the agent has come: what was printed before it was a banner.
  void greeted();
  [[nodiscard]] bool is_greeted() const { return is_greeted_; }

  /// Why it ended: the error message of ssh, or else what was observed here.
  [[nodiscard]] std::string reason_of(const std::string& observed);
  /// Whether ssh could not connect to the host, which may be off.
  [[nodiscard]] bool is_out_of_reach();

 private:
  explicit Ssh(Process process) : process_(std::move(process)) {}
  Status open(Loop& loop, Conversation::Callbacks callbacks);
  /// Keeps the end of ssh's error output, which says why it cannot connect.
  void read_errors();

  Process process_;
  std::string errors_;
  bool is_greeted_ = false;
  Loop::Handle readable_;
  std::unique_ptr<Conversation> conversation_;
};

}  // namespace hc::hosts
