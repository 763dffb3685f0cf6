// SPDX-License-Identifier: Apache-2.0
#pragma once
// The outlets of a module: the links by which its messages leave. Internal.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hc/contract/report.h>
#include <hc/link/policy.h>
#include <hc/module/adaptation.h>
#include <hc/module/arguments.h>
#include <hc/module/link_opener.h>
#include <hc/module/trace.h>

namespace hc {
namespace internal {

/// Links whose images are adapted alike to their bandwidth.
struct AdaptedLinks {
  Adaptation adaptation;
  std::vector<std::weak_ptr<const Outlet>> outlets;

  /// Whether one of them has not handed over its last image.
  [[nodiscard]] bool is_behind() const;
};

}  // namespace internal

class Module::Outlets {
 public:
  /// Calls while an outlet waits, on the thread that sends.
  struct Calls {
    std::function<void(const internal::Outlet* blocked)> report_blocked;  ///< null: no longer
    std::function<bool()> obey;  ///< for commands; see LinkOptions::Interrupt
  };
  Outlets(Module& module, internal::Trace& trace, LinkOpener& opener, Calls calls)
      : module_(module), trace_(trace), opener_(opener), calls_(std::move(calls)) {}

  /// Opens the links of a command line; without any, outputs share standard output.
  void open(const internal::Arguments& arguments);
  void open(const internal::PortLink& link);

  /// Ends an outlet, with the loss of its queued messages; null if it does not exist.
  std::shared_ptr<internal::Outlet> abandon(const internal::PortLink& link);
  void remove(const internal::PortLink& link, const std::shared_ptr<internal::Outlet>& outlet);
  /// Frees removed outlets, but not within send().
  void free_removed() { removed_.clear(); }

  void set_route(const std::string& link, const internal::Route& route);

  /// Counts their readers, but not within send().
  void count_peers();
  void add_counters(std::vector<LinkCounters>& rows) const;
  void add_ends(std::vector<LinkEnd>& rows) const;
  [[nodiscard]] std::size_t index_of(const internal::Outlet* outlet) const;

  /// Closes all. Errors: that of the first that fails.
  Status close();

 private:
  /// @param keep  of an output that never waits; else 0.
  std::shared_ptr<internal::Outlet> open(const Uri& uri, const std::string& port,
                                         std::uint32_t keep);
  void adapt(const std::shared_ptr<internal::Outlet>& outlet, const internal::Policy& policy) const;
  internal::OutputState& output_of(const internal::PortLink& link) {
    return link.is_trace ? trace_.output : *module_.outputs_[link.port];
  }

  Module& module_;
  internal::Trace& trace_;
  LinkOpener& opener_;
  Calls calls_;
  bool is_late_ = false;  // the graph runs already: --join, or a command
  std::vector<std::shared_ptr<internal::Outlet>> outlets_;  // in the order of the command line
  std::vector<std::shared_ptr<internal::Outlet>> removed_;
};

}  // namespace hc
