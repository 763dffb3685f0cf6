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

namespace {

struct Parameters {
  hc::Module& module;

  hc::Parameter<double> rate = module.parameter(
      "rate", 50.0, "Hz",
      "how often the focus is decided and repeated; an exclusive input trusts it for 0.12 s",
      {.min = 20, .max = 1000});
  hc::Parameter<double> margin =
      module.parameter("margin", 0.1, "", "by which a challenger must exceed the bid in focus",
                       {.min = 0, .max = 1});
  hc::Parameter<double> dwell =
      module.parameter("dwell", 1.0, "s", "minimum time a mode keeps the focus while it bids",
                       {.min = 0, .max = 86400});
  hc::Parameter<double> expiry =
      module.parameter("expiry", 1.0, "s", "how long a bid is valid", {.min = 0.001, .max = 86400});
  hc::Parameter<double> person_expiry = module.parameter(
      "person_expiry", 60.0, "s", "how long a person's bid is valid", {.min = 0.001, .max = 86400});
  hc::Parameter<std::string> modes = module.parameter(
      hc::kModeNames, "", "", "names of modes, e.g. read=5,track=4: set by `hc run`");
  hc::Parameter<std::string> sources =
      module.parameter(hc::kSourceNames, "", "",
                       "names of sources of bids and stops, by src, e.g. web.stop=12: set by "
                       "`hc run`");
  hc::Parameter<std::string> stops =
      module.parameter(hc::kStops, "", "",
                       "sources that have stopped (1) or guard (0) the robot, by src, "
                       "e.g. 12=1,14=0: set by `hc run` at a "
                       "restart",
                       {.fixed = true});

  [[nodiscard]] WorkspaceOptions options() const {
    return {*margin, hc::duration(*dwell), hc::duration(*expiry), hc::duration(*person_expiry)};
  }
};

/// The workspace with its ports.
class Program {
 public:
  explicit Program(hc::Module& module);

  void log_refused() const;

 private:
  using Table = hc::MessageOf<hc::TableKind<double>>;
  using Bid = hc::Status (Workspace::*)(const Bidder&, double, hc::MonotonicTime,
                                        hc::MonotonicTime);

  void start();
  void take(const Table& message, Bid bid);
  void brake(const hc::Header& header, std::uint8_t word);
  void decide();

  /// @param checked  called with the names or an error, gives the names if they are valid.
  template <typename Checked>
  void read_names(const Checked& checked);
  /// Time of a message on the monotonic clock.
  [[nodiscard]] hc::MonotonicTime made_at(const hc::Header& header) const;
  void report();
  void send_stopped();
  void send_standings(hc::MonotonicTime now, hc::Time time);

  hc::Module& module_;
  // Queues, since bids for several modes, and stops of several sources, may share a link.
  hc::Input<hc::TableKind<double>> bids_ = module_.input(
      "bids", hc::table(), "salience 0 … 1 for the message's mode and src; 0 withdraws that bid",
      {.keep = 16});
  hc::Input<hc::TableKind<double>> person_ =
      module_.input("person", hc::table(),
                    "the same from a person; overrides all tasks while valid", {.keep = 16});
  hc::Input<hc::TableKind<std::uint8_t>> stop_ =
      module_.input("stop", hc::table<std::uint8_t>().of(1, 1),
                    "1: stops the robot until the same src sends 0; 0, repeated: the src "
                    "guards, and its silence stops too; 2: a person clears all stops; 3: "
                    "the src ends guarding",
                    {.keep = 16});
  hc::Output<hc::TableKind<std::int32_t>> focus_ =
      module_.output("focus", hc::table<std::int32_t>().of(1, 1),
                     "number of the mode in focus, 0 none; each period");
  hc::Output<hc::TableKind<double>> standings_ =
      module_.output("standings", hc::table(), "a row for each mode with a bid",
                     {.columns = {"mode", "salience", "age [s]", "in focus", "of a person"}});
  hc::Output<hc::TableKind<std::uint8_t>> stopped_ =
      module_.output("stopped", hc::table<std::uint8_t>().of(1, 1),
                     "1 while it is stopped, else 0; at each change, and ten times a second");
  const Parameters parameters_{module_};

  Workspace workspace_;
  std::optional<hc::MonotonicTime> complained_;  // last log of a refused bid, at most once a second
  std::string modes_read_, sources_read_;
};

Program::Program(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(bids_, [this](const auto& message) { take(message, &Workspace::bid); });
  module.on(person_, [this](const auto& message) { take(message, &Workspace::bid_of_person); });
  module.on(stop_, [this](const auto& message) { brake(message.header, message.numbers()[0]); });
  module.every(std::chrono::milliseconds(100), [this] { send_stopped(); });
  module.every(parameters_.rate, [this] { decide(); });
}

void Program::start() {
  read_names([](auto names) { return std::optional(hc::value_or_end(std::move(names))); });
  workspace_.brake.restore(
      hc::value_or_refuse(parameters_.stops, hc::parse_stops(*parameters_.stops)));
  if (workspace_.brake.is_stopped())
    module_.log(workspace_.brake.reason(module_.monotonic()) + ", before the restart");
}

void Program::take(const Table& message, Bid bid) {
  const auto now = module_.monotonic();
  const auto numbers = hc::value_or_drop(hc::view<double>(message)).numbers();
  // Not exactly one number: refused like an invalid salience.
  const double salience = numbers.size() == 1 ? numbers[0] : -1;
  const Bidder who{message.header.mode, message.header.src};
  auto taken = (workspace_.*bid)(who, salience, made_at(message.header), now);
  if (taken || (complained_ && now - *complained_ < std::chrono::seconds(1))) return;
  complained_ = now;
  module_.log("bid refused: " + taken.error().text() + "; " +
              std::to_string(workspace_.refused().total()) + " refused so far");
}

void Program::brake(const hc::Header& header, std::uint8_t word) {
  auto& brake = workspace_.brake;
  const auto now = module_.monotonic();
  const bool was_stopped = brake.is_stopped();
  const auto taken = brake.take({header.src, word, header.seq, made_at(header)}, now);
  if (!taken) return module_.log_once("stop refused", "stop refused: " + taken.error().detail);
  report();
  const auto source = brake.name(header.src);
  if (word == Brake::kFree && brake.stops_robot(header.src))
    module_.log_once("stop kept", "the stop of " + source +
                                      " holds: it was silent or restarted meanwhile, and may not "
                                      "know of it; clear it in the page");
  if (was_stopped == brake.is_stopped()) return;
  module_.log(was_stopped ? "stop cleared by " + source : brake.reason(now));
  send_stopped();
}

void Program::decide() {
  auto now = module_.monotonic();
  read_names([this](auto names) {  // invalid names do not end a running module
    if (!names) module_.log_once("invalid names", names.error().detail);
    return names;
  });
  workspace_.set_options(parameters_.options());
  if (workspace_.decide(now)) module_.log("focus: " + workspace_.last_change());
  report();
  const hc::Time time = module_.now();
  focus_.send(workspace_.focus(), time);
  send_standings(now, time);
}

template <typename Checked>
void Program::read_names(const Checked& checked) {
  const auto &modes = *parameters_.modes, &sources = *parameters_.sources;
  if (std::exchange(modes_read_, modes) != modes)
    if (auto names = checked(hc::parse_mode_names(modes_read_)))
      workspace_.set_modes(std::move(*names));
  if (std::exchange(sources_read_, sources) != sources)
    if (auto names = checked(hc::parse_mode_names(sources_read_, hc::kSourceNames)))
      workspace_.brake.set_names(std::move(*names));
}

hc::MonotonicTime Program::made_at(const hc::Header& header) const {
  const auto age = header.time == hc::Time() ? hc::MonotonicTime(0) : module_.now() - header.time;
  return module_.monotonic() - age;
}

void Program::report() {
  hc::ModuleAccess::report_focus(module_, workspace_.focus(), workspace_.brake.stops());
}

void Program::send_stopped() {
  const std::uint8_t is_stopped = workspace_.brake.is_stopped() ? 1 : 0;
  stopped_.send(is_stopped, module_.now());
}

void Program::send_standings(hc::MonotonicTime now, hc::Time time) {
  auto rows = workspace_.standings(now);
  auto draft = standings_.loan(static_cast<std::int32_t>(rows.size()), 5);
  draft.header.time = time;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto row = draft.matrix().row(i);
    row[0] = rows[i].mode;
    row[1] = rows[i].salience;
    row[2] = std::chrono::duration<double>(rows[i].age).count();
    row[3] = rows[i].in_focus ? 1 : 0;
    row[4] = rows[i].is_of_person ? 1 : 0;
  }
  standings_.send(std::move(draft));
}

void Program::log_refused() const {
  if (const Refused& refused = workspace_.refused(); refused.total() > 0)
    module_.log(
        hc::format("bids refused: {} for their salience, {} for their mode, {} for their "
                   "time, {} over the limit",
                   refused.salience, refused.mode, refused.time, refused.crowded));
}

}  // namespace

int run_workspace(int argc, char** argv, const hc::Clock& clock) {
  hc::Module module{
      "workspace", "Grants the focus to the highest bid and publishes it.", {.clock = &clock}};
  Program program{module};
  const int status = module.run(argc, argv);
  program.log_refused();
  return status;
}
