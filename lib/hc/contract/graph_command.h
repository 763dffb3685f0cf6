// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands to a running graph and its answers, as messages. The commands of a message, one per row,
// are executed all or not at all (spec/graph.md, G47). Pure.

#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc {

/// "MODULE.PARAMETER=VALUE"; the value is everything after the first `=`.
struct Assignment {
  std::string module, parameter, value;
};
/// Errors: Invalid.
Result<Assignment> parse_assignment(std::string_view text);

struct GraphCommand {
  enum class Verb {
    Set,
    Add,
    Remove,
    Restart,
    Link,
    Unlink,
    Stop,
    Describe,
    Observe,
    Feed,
    Notices
  };

  Verb verb = Verb::Stop;
  std::vector<std::string> words;  ///< after the verb; for `set`: module, parameter, value

  /// Whether it changes the graph itself, not only what is running.
  [[nodiscard]] bool is_edit() const {
    return verb != Verb::Restart && verb != Verb::Stop && !is_question();
  }
  /// Whether it asks something, which must be alone in a message, and leaves the graph as it is.
  [[nodiscard]] bool is_question() const {
    return verb == Verb::Describe || verb == Verb::Observe || verb == Verb::Feed ||
           verb == Verb::Notices;
  }
};

/// Errors: Invalid.
Result<GraphCommand> parse_graph_command(std::string_view line);

struct GraphRequest {
  std::string reply;               ///< `unix:` URI for the answer; empty: no answer
  std::vector<std::string> lines;  ///< one command each
};
Message make_request(const GraphRequest& request);
GraphRequest read_request(const Message& message);

struct GraphAnswer {
  bool is_ok = false;
  /// If ok, the data requested, or remarks; otherwise at least one error.
  std::vector<std::string> rows;
};
Message make_answer(const GraphAnswer& answer);
GraphAnswer read_answer(const Message& message);

}  // namespace hc
