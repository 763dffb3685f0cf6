// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <string>

#include <hc/module/module.h>

#include "workspace.h"

namespace {

std::chrono::nanoseconds seconds(double value) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(value));
}

/// Tells of refused bids, once a second at most.
class Complaints {
 public:
  void tell(const hc::Module& module, const hc::Error& why, const Refused& refused,
            hc::MonotonicTime now) {
    if (told_ && now - *told_ < std::chrono::seconds(1)) return;
    told_ = now;
    module.log("bid refused: " + why.text() + "; " + std::to_string(refused.total()) +
               " refused so far");
  }

 private:
  std::optional<hc::MonotonicTime> told_;
};

}  // namespace

int run_workspace(int argc, char** argv, const hc::Clock& clock) {
  hc::Module module{"workspace", "Gives the focus to the mode that bids most, and tells all.",
                    clock};
  auto bids = module.input("bids", hc::table<double>(),
                           "1 x 1: salience 0 … 1 of the message's mode; 0 withdraws");
  auto person = module.input("person", hc::table<double>(),
                             "the same from a person, above all others while it stands");
  auto focus = module.output("focus", hc::table<std::int32_t>(),
                             "1 x 1: number of the mode in focus, 0 none; each period");
  auto standings = module.output(
      "standings", hc::table<double>(),
      "a row for each mode with a bid: mode, salience, age [s], in focus 0/1, a person's 0/1");
  auto rate = module.parameter("rate", 20.0, "Hz", "how often it is decided who has the focus",
                               {.min = 0.1, .max = 1000});
  auto margin = module.parameter("margin", 0.1, "",
                                 "by more than which a challenger's salience must be greater",
                                 {.min = 0, .max = 1});
  auto dwell = module.parameter("dwell", 1.0, "s", "how long the focus stays where it is at least",
                                {.min = 0, .max = 86400});
  auto expiry =
      module.parameter("expiry", 1.0, "s", "how long a bid stands", {.min = 0.001, .max = 86400});
  auto person_expiry = module.parameter(
      "person_expiry", 60.0, "s", "how long a person's bid stands", {.min = 0.001, .max = 86400});

  Workspace workspace;
  Complaints complaints;
  auto take = [&](const hc::Message& message, auto bid) {
    auto now = module.monotonic();
    auto numbers = hc::value_or_end(message.view<double>()).numbers();
    // Without its one number a bid has a salience that is refused as any other.
    double salience = numbers.size() == 1 ? numbers[0] : -1;
    auto taken = (workspace.*bid)(message.header.mode, salience, now);
    if (!taken) complaints.tell(module, taken.error(), workspace.refused(), now);
  };
  module.on(bids, [&](const auto& message) { take(message, &Workspace::bid); });
  module.on(person, [&](const auto& message) { take(message, &Workspace::bid_of_person); });

  module.every(rate, [&] {
    auto now = module.monotonic();
    workspace.set_options({*margin, seconds(*dwell), seconds(*expiry), seconds(*person_expiry)});
    workspace.decide(now);
    const std::int64_t time = module.now();
    auto told = hc::table({workspace.focus()});
    told.header.time = time;
    focus.send(told);
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
