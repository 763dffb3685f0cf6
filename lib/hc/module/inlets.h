// SPDX-License-Identifier: Apache-2.0
#pragma once
// The inlets of a module: the links by which messages arrive. Internal.

#include <string>
#include <vector>

#include <hc/module/arguments.h>
#include <hc/module/inlet.h>
#include <hc/module/link_opener.h>
#include <hc/module/sets.h>

namespace hc {

class Module::Inlets {
 public:
  Inlets(Module& module, internal::Now& now, LinkOpener& opener, Delivery& delivery)
      : module_(module),
        now_(now),
        opener_(opener),
        delivery_(delivery),
        sets_(module, delivery, inlets_) {}

  /// Opens the links of a command line; without any, inputs share standard input.
  void open(const internal::Arguments& arguments);
  void open(const internal::PortLink& link);
  bool remove(const internal::PortLink& link);
  /// The writer of a link will not return: see Source::finish().
  void finish(const internal::PortLink& link);
  void set_route(const std::string& link, const internal::Route& route);
  /// Merges links that have ended with the same links, opened again, whose counters continue.
  /// @returns  whether there are any.
  bool join_renewed();
  /// Ends synchronised links that cannot be part of a set any more.
  void end_unneeded();
  /// Whether no message can arrive any more. False without links if a command may add one, or if
  /// the module has only timers.
  [[nodiscard]] bool all_ended() const;
  /// Whether an input had links, and all have ended.
  [[nodiscard]] bool have_ended(const internal::InputState& input) const;

  /// Takes and handles a message of each link; false if there is none. Links with a crowded queue
  /// of messages that wait for partners are read only if no other link has a message.
  bool take_each();
  void receive_focus();
  /// Takes the next message of a link, which ends if there are no more.
  Got take(internal::Inlet& inlet, Message& message);

  /// Calls a function with each inlet, those of the focus first.
  template <typename Call>
  void for_each(const Call& call) {
    for (auto* inlets : {&focus_, &inlets_})
      for (auto& inlet : *inlets) call(inlet);
  }
  [[nodiscard]] std::size_t size() const { return inlets_.size(); }
  [[nodiscard]] Sets& sets() { return sets_; }
  void add_counters(std::vector<LinkCounters>& rows);
  void add_ends(std::vector<LinkEnd>& rows) const;

 private:
  void open(const Uri& uri, std::vector<internal::InputState*> inputs);
  bool take_one(internal::Inlet& inlet);
  void end(internal::Inlet& inlet);

  Module& module_;
  internal::Now& now_;
  LinkOpener& opener_;
  Delivery& delivery_;
  std::vector<internal::Inlet> inlets_, focus_;
  Sets sets_;
};

}  // namespace hc
