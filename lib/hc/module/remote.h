// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands from `hc run`, and reports to it (spec/module.md). Internal.

#include <string>
#include <vector>

#include <hc/contract/command.h>
#include <hc/contract/trace.h>
#include <hc/module/arguments.h>
#include <hc/module/inlets.h>
#include <hc/module/management.h>
#include <hc/module/outlets.h>

namespace hc {

class Module::Remote {
 public:
  Remote(Module& module, internal::Now& now, LinkOpener& opener, Inlets& inlets, Outlets& outlets)
      : module_(module), now_(now), opener_(opener), inlets_(inlets), outlets_(outlets) {}

  void open(const internal::Arguments& arguments);
  /// The link for commands; null: none.
  [[nodiscard]] Source* commands() const { return module_.management_->commands(); }

  /// When serve() is to be called without a new command.
  [[nodiscard]] MonotonicTime due() const;
  /// Obeys commands, and sends a report that is due.
  void serve();
  /// While send() waits, obeys commands that do not touch inputs, which may be in use; serve()
  /// obeys the others. False if there are no more.
  bool obey_while_sending();

  /// Errors: Invalid.
  Status set_parameter(const std::string& name, const std::string& value);

  void report_links();
  /// Also without links, to show that the module responds.
  void report_counters();
  /// @param blocked  outlet that waits for its reader; null: none.
  void report_state(const internal::Outlet* blocked = nullptr);

 private:
  void obey(const std::string& row);
  Status carry_out(const ModuleCommand& command);
  Status link(bool is_input, const std::string& text);
  Status unlink(bool is_input, const std::string& text);
  /// Notes a change of an output's link in the trace, since it may send messages in another form.
  void note(TraceEvent::What what, bool is_input, const internal::PortLink& link) const;
  void report_parameters();
  void send(Report report, Message message);

  Module& module_;
  internal::Now& now_;
  LinkOpener& opener_;
  Inlets& inlets_;
  Outlets& outlets_;
  std::vector<std::string> deferred_;  // commands, see obey_while_sending()
  MonotonicTime reported_{0};          // counters, the last time
};

}  // namespace hc
