// SPDX-License-Identifier: Apache-2.0
// The supervisor's head, by any tracker that opentrack knows.
#include <drivers/head_tracker/head_tracker.h>

#include <algorithm>

#include <hc/base/clock.h>
#include <hc/base/program.h>
#include <hc/node/module.h>

namespace {

constexpr std::int32_t kSupervisor = 14;
constexpr std::chrono::milliseconds kLook{20};  // how long inputs and silence may go unnoticed

template <typename Output>
void send(Output& output, const Eigen::Vector3d& numbers, std::int64_t time) {
  auto draft = output.loan(1, 1);
  draft.header.time = time;
  std::copy_n(numbers.data(), 3, draft.matrix().numbers().begin());
  output.send(std::move(draft));
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"head_tracker", "Follows a person's head by a tracker that opentrack knows."};
  auto centre = module.input("centre", hc::anything(), "makes the head's pose the new zero");
  auto rotation = module.output("rotation", hc::rotation<double>().in(kSupervisor),
                                "roll, pitch, yaw since the zero [rad]; yaw > 0 turns left, pitch "
                                "> 0 looks down");
  auto position = module.output("position", hc::position<double>().in(kSupervisor),
                                "x forward, y left, z up since the zero [m]");
  auto host =
      module.parameter("host", "127.0.0.1", "",
                       "address of this machine to listen at, 0.0.0.0: all", {.fixed = true});
  auto port =
      module.parameter("port", 4242, "", "UDP port", {.least = 0, .most = 65535, .fixed = true});
  auto centre_first =
      module.parameter("centre_first", true, "", "the first pose is the zero; else the tracker's");
  auto silence =
      module.parameter("silence", 1.0, "s", "a tracker that says nothing so long is gone",
                       {.least = 0.01, .most = 3600});

  const hc::SystemClock clock;
  std::optional<hc::HeadTracker> tracker;
  std::optional<hc::Presence> presence;
  hc::HeadPose zero;
  bool centre_next = false, first = true;
  std::string where;

  module.on(centre, [&](const hc::Message&) { centre_next = true; });
  module.on_start([&] {
    tracker.emplace(hc::value_or_end(hc::HeadTracker::open(*host, static_cast<int>(*port))));
    where = *host + ":" + std::to_string(tracker->port());
    presence.emplace(clock.monotonic());
    module.log("listens at UDP " + where);
  });
  auto tell = [&](hc::Presence::Change change) {
    if (change == hc::Presence::Change::Came) module.log("hears a tracker");
    if (change == hc::Presence::Change::Silent) module.log("no tracker is heard at UDP " + where);
  };
  module.generate([&] {
    const auto ignored = tracker->ignored();
    auto heard = hc::value_or_end(tracker->receive(kLook, hc::stop_descriptor()));
    if (ignored == 0 && tracker->ignored() > 0)
      module.log("ignores " + tracker->why_ignored() + ", as it will others that are no pose");
    const auto silent = std::chrono::duration<double>(*silence);
    tell(presence->look(clock.monotonic(), heard.has_value(),
                        std::chrono::duration_cast<std::chrono::nanoseconds>(silent)));
    if (!heard) return true;
    if (centre_next || (first && *centre_first)) zero = heard->pose;
    centre_next = first = false;
    const auto pose = heard->pose.relative_to(zero);
    send(rotation, pose.angles(), heard->time);
    send(position, pose.p, heard->time);
    return true;
  });
  const int status = module.run(argc, argv);
  if (tracker && tracker->ignored() > 0)
    module.log(std::to_string(tracker->ignored()) + " packets ignored");
  return status;
}
