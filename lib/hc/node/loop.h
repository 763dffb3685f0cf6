// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module at work: takes messages from its links and hands them to the handlers. Internal.

#include <memory>
#include <string>
#include <vector>

#include <hc/node/arguments.h>
#include <hc/node/module.h>

namespace hc {

namespace internal {

/// Thrown to end a module cleanly: nobody reads it any more, or it was told to stop.
struct Stopped {};

/// A link from which inputs are fed: one port, or all of them from standard input.
struct LinkedSource {
  std::string uri;
  std::unique_ptr<Source> source;  ///< null once it has ended
  std::vector<InputState*> inputs;
  Traffic traffic;
};

}  // namespace internal

struct Module::Loop {
  /// Opens the links: outputs first, since those that listen must be there before anybody waits.
  Loop(Module& module, const internal::Arguments& arguments, int stop);

  /// Until all inputs have ended, and the generator has.
  void run();
  /// Ends the outputs.
  void close();

 private:
  void open_outputs(const internal::Arguments& arguments);
  void open_inputs(const internal::Arguments& arguments);
  bool take_each();
  bool take_one(internal::LinkedSource& link);
  [[nodiscard]] bool is_linked(const internal::InputState& input) const;
  void end(internal::LinkedSource& link);
  void end_unlinked();
  void end_unneeded();
  void tell_left_out();
  void deliver(internal::LinkedSource& link, const Message& message);
  void wait();
  void report();

  Module& module_;
  LinkOptions options_;
  std::vector<internal::LinkedSource> sources_;
  std::vector<std::shared_ptr<internal::LinkedSink>> sinks_;  // in the order of the command line
  std::unique_ptr<Sink> manage_;
  MonotonicTime reported_{0};
  std::int64_t reports_ = 0;
};

}  // namespace hc
