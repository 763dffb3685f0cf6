// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <optional>
#include <string>
#include <utility>

#include <hc/base/format.h>
#include <hc/contract/mode_names.h>
#include <hc/contract/stops.h>
#include <hc/module/module.h>

#include "workspace.h"

int run_workspace(int argc, char** argv, const hc::Clock& clock) {
  hc::Module module{"workspace", "Grants the focus to the highest bid and publishes it.", {.clock = &clock}};
  auto bids = module.input("bids", hc::table(),
                           "salience 0 … 1 for the message's mode and src; 0 withdraws that bid", {.keep = 16});
  auto person = module.input("person", hc::table(),
                             "the same from a person; overrides all tasks while valid", {.keep = 16});
  auto stop = module.input("stop", hc::table<std::uint8_t>().of(1, 1),
                           "1: stops the robot until the same src sends 0; 0, repeated: the src "
                           "guards, and its silence stops too; 2: a person clears all stops; 3: "
                           "the src ends guarding", {.keep = 16});
  // Queues, since bids for several modes, and stops of several sources, may share a link.
  auto focus = module.output("focus", hc::table<std::int32_t>().of(1, 1),
                             "number of the mode in focus, 0 none; each period");
  auto standings = module.output(
      "standings", hc::table(),
      "a row for each mode with a bid: mode, salience, age [s], in focus 0/1, a person's 0/1");
  auto stopped =
      module.output("stopped", hc::table<std::uint8_t>().of(1, 1),
                    "1 while it is stopped, else 0; at each change, and ten times a second");
  auto rate = module.parameter(
      "rate", 50.0, "Hz",
      "how often the focus is decided and repeated; an exclusive input trusts it for 0.12 s",
      {.min = 20, .max = 1000});
  auto margin =
      module.parameter("margin", 0.1, "", "by which a challenger must exceed the bid in focus",
                       {.min = 0, .max = 1});
  auto dwell =
      module.parameter("dwell", 1.0, "s", "minimum time a mode keeps the focus while it bids",
                       {.min = 0, .max = 86400});
  auto expiry =
      module.parameter("expiry", 1.0, "s", "how long a bid is valid", {.min = 0.001, .max = 86400});
  auto person_expiry = module.parameter(
      "person_expiry", 60.0, "s", "how long a person's bid is valid", {.min = 0.001, .max = 86400});
  auto modes = module.parameter(hc::kModeNames, "", "",
                                "names of modes, e.g. read=5,track=4: set by `hc run`");
  auto sources =
      module.parameter(hc::kSourceNames, "", "",
                       "names of sources of bids and stops, by src, e.g. web.stop=12: set by "
                       "`hc run`");
  auto stops = module.parameter(hc::kStops, "", "",
                                "sources that have stopped (1) or guard (0) the robot, by src, "
                                "e.g. 12=1,14=0: set by `hc run` at a "
                                "restart",
                                {.fixed = true});

  Workspace workspace;
  std::optional<hc::MonotonicTime> complained;  // last log of a refused bid, at most once a second
  std::string modes_read, sources_read;
  auto read_names = [&](auto checked) {
    if (std::exchange(modes_read, *modes) != *modes)
      if (auto names = checked(hc::parse_mode_names(modes_read)))
        workspace.set_modes(std::move(*names));
    if (std::exchange(sources_read, *sources) != *sources)
      if (auto names = checked(hc::parse_mode_names(sources_read, hc::kSourceNames)))
        workspace.brake.set_names(std::move(*names));
  };
  auto report = [&] { hc::ModuleAccess::report_focus(module, workspace.focus(), workspace.brake.stops()); };
  auto send_stopped = [&] {
    const std::uint8_t is_stopped = workspace.brake.is_stopped() ? 1 : 0;
    stopped.send({is_stopped}, module.now());
  };
  /// Time of a message on the monotonic clock.
  auto made_at = [&](const hc::Header& header) {
    const auto age = header.time == 0 ? 0 : module.now() - header.time;
    return module.monotonic() - std::chrono::nanoseconds(age);
  };
  module.on_start([&] {
    read_names([](auto names) { return std::optional(hc::value_or_end(std::move(names))); });
    workspace.brake.restore(hc::value_or_end(hc::parse_stops(*stops)));
    if (workspace.brake.is_stopped())
      module.log(workspace.brake.reason(module.monotonic()) + ", before the restart");
  });
  auto take = [&](const hc::Message& message, auto bid) {
    const auto now = module.monotonic();
    const auto numbers = hc::value_or_drop(message.view<double>()).numbers();
    // Not exactly one number: refused like an invalid salience.
    const double salience = numbers.size() == 1 ? numbers[0] : -1;
    const Bidder who{message.header.mode, message.header.src};
    auto taken = (workspace.*bid)(who, salience, made_at(message.header), now);
    if (taken || (complained && now - *complained < std::chrono::seconds(1))) return;
    complained = now;
    module.log("bid refused: " + taken.error().text() + "; " +
               std::to_string(workspace.refused().total()) + " refused so far");
  };
  module.on(bids, [&](const auto& message) { take(message, &Workspace::bid); });
  module.on(person, [&](const auto& message) { take(message, &Workspace::bid_of_person); });

  module.on(stop, [&](const auto& message) {
    auto& brake = workspace.brake;
    const auto& header = message.header;
    const auto now = module.monotonic();
    const auto word = message.numbers()[0];
    const bool was_stopped = brake.is_stopped();
    const auto taken = brake.take({header.src, word, header.seq, made_at(header)}, now);
    if (!taken) return module.log_once("stop refused", "stop refused: " + taken.error().detail);
    report();
    const auto source = brake.name(header.src);
    if (word == Brake::kFree && brake.stops_robot(header.src))
      module.log_once("stop kept", "the stop of " + source +
                                       " holds: it was silent or restarted meanwhile, and may not "
                                       "know of it; clear it in the page");
    if (was_stopped == brake.is_stopped()) return;
    module.log(was_stopped ? "stop cleared by " + source : brake.reason(now));
    send_stopped();
  });

  module.every(std::chrono::milliseconds(100), send_stopped);
  module.every(rate, [&] {
    auto now = module.monotonic();
    read_names([&](auto names) {  // invalid names do not end a running module
      if (!names) module.log_once("invalid names", names.error().detail);
      return names;
    });
    workspace.set_options(
        {*margin, hc::duration(*dwell), hc::duration(*expiry), hc::duration(*person_expiry)});
    if (workspace.decide(now)) module.log("focus: " + workspace.last_change());
    report();
    const std::int64_t time = module.now();
    focus.send({workspace.focus()}, time);
    auto rows = workspace.standings(now);
    auto draft = standings.loan(static_cast<std::int32_t>(rows.size()), 5);
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
    module.log(
        hc::format("bids refused: {} for their salience, {} for their mode, {} for their "
                   "time, {} over the limit",
                   refused.salience, refused.mode, refused.time, refused.crowded));
  return status;
}
