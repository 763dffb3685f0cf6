// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <map>
#include <string>

#include <hc/contract/mode_names.h>
#include <hc/module/module.h>

#include "workspace.h"

namespace {

/// Logs refused bids, once a second at most.
class Complaints {
 public:
  void log(const hc::Module& module, const hc::Error& why, const Refused& refused,
           hc::MonotonicTime now) {
    if (logged_ && now - *logged_ < std::chrono::seconds(1)) return;
    logged_ = now;
    module.log("bid refused: " + why.text() + "; " + std::to_string(refused.total()) +
               " refused so far");
  }

 private:
  std::optional<hc::MonotonicTime> logged_;
};

}  // namespace

int run_workspace(int argc, char** argv, const hc::Clock& clock) {
  hc::Module module{"workspace", "Grants the focus to the highest bid and publishes it.", clock};
  auto bids = module.input("bids", hc::table<double>(),
                           "salience 0 … 1 of the message's mode; 0 withdraws");
  auto person = module.input("person", hc::table<double>(),
                             "the same from a person, above all others while it is valid");
  auto stop = module.input("stop", hc::table<std::uint8_t>().of(1, 1),
                           "1: no mode has the focus until a 0 comes");
  // More than one, since bids for several modes, and stops of several sources, may share a link.
  module.keep(bids, 16);
  module.keep(person, 16);
  module.keep(stop, 16);
  auto focus = module.output("focus", hc::table<std::int32_t>().of(1, 1),
                             "number of the mode in focus, 0 none; each period");
  auto standings = module.output(
      "standings", hc::table<double>(),
      "a row for each mode with a bid: mode, salience, age [s], in focus 0/1, a person's 0/1");
  auto stopped = module.output("stopped", hc::table<std::uint8_t>().of(1, 1),
                               "1 while it is stopped, else 0; ten times a second");
  auto rate = module.parameter(
      "rate", 20.0, "Hz",
      "how often the focus is decided and repeated; an exclusive input trusts it for 0.2 s",
      {.min = 20, .max = 1000});
  auto margin =
      module.parameter("margin", 0.1, "", "a challenger must bid more than the focus does by this",
                       {.min = 0, .max = 1});
  auto dwell =
      module.parameter("dwell", 1.0, "s", "how long a mode keeps the focus at least, while it bids",
                       {.min = 0, .max = 86400});
  auto expiry =
      module.parameter("expiry", 1.0, "s", "how long a bid is valid", {.min = 0.001, .max = 86400});
  auto person_expiry = module.parameter(
      "person_expiry", 60.0, "s", "how long a person's bid is valid", {.min = 0.001, .max = 86400});
  auto modes = module.parameter(hc::kModeNames, "", "",
                                "names of modes, e.g. read=5,track=4: set by `hc run`");

  Workspace workspace;
  Complaints complaints;
  std::map<std::int32_t, std::string> names;
  auto log_change = [&] {
    if (auto read = hc::parse_mode_names(*modes))
      names = std::move(*read);
    else
      module.log_once("invalid mode_names", read.error().detail);
    module.log("focus: " + workspace.last_change(names));
  };
  module.on_start([&] { names = hc::value_or_end(hc::parse_mode_names(*modes)); });
  auto take = [&](const hc::Message& message, auto bid) {
    auto now = module.monotonic();
    auto numbers = hc::value_or_drop(message.view<double>()).numbers();
    // Without its one number a bid has a salience that is refused as any other.
    double salience = numbers.size() == 1 ? numbers[0] : -1;
    auto taken = (workspace.*bid)(message.header.mode, salience, now);
    if (!taken) complaints.log(module, taken.error(), workspace.refused(), now);
  };
  module.on(bids, [&](const auto& message) { take(message, &Workspace::bid); });
  module.on(person, [&](const auto& message) { take(message, &Workspace::bid_of_person); });

  module.on(stop, [&](const auto& message) {
    const bool is_stopped = message.numbers()[0] != 0;
    if (is_stopped != workspace.is_stopped()) module.log(is_stopped ? "stopped" : "stop cleared");
    workspace.stop(is_stopped);
  });

  module.every(std::chrono::milliseconds(100), [&] {
    const std::uint8_t is_stopped = workspace.is_stopped() ? 1 : 0;
    stopped.send(hc::table({is_stopped}).at(module.now()));
  });
  module.every(rate, [&] {
    auto now = module.monotonic();
    workspace.set_options(
        {*margin, hc::duration(*dwell), hc::duration(*expiry), hc::duration(*person_expiry)});
    if (workspace.decide(now)) log_change();
    module.report_focus(workspace.focus());
    const std::int64_t time = module.now();
    auto message = hc::table({workspace.focus()});
    message.header.time = time;
    focus.send(message);
    auto rows = workspace.standings(now);
    auto draft = standings.loan(5, static_cast<std::int32_t>(rows.size()));
    draft.header.time = time;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto row = draft.matrix().row(i);
      row[0] = rows[i].mode;
      row[1] = rows[i].salience;
      row[2] = std::chrono::duration<double>(rows[i].age).count();
      row[3] = rows[i].in_focus ? 1 : 0;
      row[4] = rows[i].is_of_person ? 1 : 0;
    }
    standings.send(std::move(draft));
  });

  int status = module.run(argc, argv);
  if (const Refused& refused = workspace.refused(); refused.total() > 0)
    module.log("bids refused: " + std::to_string(refused.salience) + " for their salience, " +
               std::to_string(refused.mode) + " for their mode, " +
               std::to_string(refused.crowded) + " that were too many");
  return status;
}
