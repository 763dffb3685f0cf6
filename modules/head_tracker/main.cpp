// SPDX-License-Identifier: Apache-2.0
// The supervisor's head, by any tracker that opentrack knows.
#include <drivers/head_tracker/head_tracker.h>

#include <poll.h>

#include <algorithm>
#include <cstdio>

#include <hc/base/clock.h>
#include <hc/module/module.h>
#include <hc/os/program.h>

namespace {

constexpr std::int32_t kSupervisor = 14;
constexpr std::chrono::milliseconds kLook{20};  // how long inputs and silence may go unnoticed

/// Tries for a port again and again: after 0.1 s, then twice as long each time, up to 2 s.
class Opening {
 public:
  /// The tracker, when it is time to try and it can be heard; an error at a new fault.
  /// Errors: Invalid (it never will be), System (told once).
  hc::Result<std::optional<hc::HeadTracker>> attempt(hc::MonotonicTime now, const std::string& host,
                                                     int port) {
    if (now < due_) return std::optional<hc::HeadTracker>();
    auto opened = hc::HeadTracker::open(host, port);
    if (opened) {
      *this = {};
      return std::optional<hc::HeadTracker>(std::move(*opened));
    }
    due_ = now + pause_;
    pause_ = std::min<std::chrono::nanoseconds>(2 * pause_, std::chrono::seconds(2));
    if (opened.error().detail == std::exchange(told_, opened.error().detail))
      return std::optional<hc::HeadTracker>();
    return opened.error();
  }

 private:
  hc::MonotonicTime due_{0};
  std::chrono::nanoseconds pause_ = std::chrono::milliseconds(100);
  std::string told_;
};

/// "roll 0.00, pitch 0.12, yaw -0.70 rad"
std::string angles_text(const hc::HeadPose& pose) {
  const Eigen::Vector3d angles = pose.angles().array() + 0.0;  // none is -0
  std::array<char, 128> text = {};
  std::snprintf(text.data(), text.size(), "roll %.2f, pitch %.2f, yaw %.2f rad", angles.x(),
                angles.y(), angles.z());
  return text.data();
}

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
      module.parameter("port", 4242, "", "UDP port", {.min = 0, .max = 65535, .fixed = true});
  auto centre_first =
      module.parameter("centre_first", true, "", "the first pose is the zero; else the tracker's");
  auto silence =
      module.parameter("silence", 1.0, "s", "a tracker that says nothing so long is gone",
                       {.min = 0.01, .max = 3600});

  const hc::SystemClock clock;
  std::optional<hc::HeadTracker> tracker;
  std::optional<hc::Presence> presence;
  hc::HeadPose zero;
  bool centre_next = false, first = true;
  std::string where;
  Opening opening;
  auto listen = [&] {
    auto opened = opening.attempt(clock.monotonic(), *host, static_cast<int>(*port));
    if (!opened && opened.error().code == hc::Code::Invalid) throw hc::ModuleError(opened.error());
    if (!opened) return module.log(opened.error().detail + "; trying again");
    if (!*opened) return;
    tracker.emplace(std::move(**opened));
    where = *host + ":" + std::to_string(tracker->port());
    module.log("listens at UDP " + where);
  };

  module.on(centre, [&](const hc::Message&) { centre_next = true; });
  module.on_start([&] {
    presence.emplace(clock.monotonic());
    listen();
  });
  auto tell = [&](hc::Presence::Change change) {
    if (change == hc::Presence::Change::Came) module.log("hears a tracker");
    if (change == hc::Presence::Change::Silent) module.log("no tracker is heard at UDP " + where);
  };
  module.generate([&] {
    if (!tracker) {
      listen();
      pollfd stop{hc::stop_descriptor(), POLLIN, 0};
      if (!tracker) ::poll(&stop, 1, static_cast<int>(kLook.count()));
      if (tracker) presence.emplace(clock.monotonic());
      return true;
    }
    const auto ignored = tracker->ignored();
    auto heard = hc::value_or_end(tracker->receive(kLook, hc::stop_descriptor()));
    if (ignored == 0 && tracker->ignored() > 0)
      module.log("ignores " + tracker->why_ignored() + ", as it will others that are no pose");
    const auto silent = std::chrono::duration<double>(*silence);
    tell(presence->look(clock.monotonic(), heard.has_value(),
                        std::chrono::duration_cast<std::chrono::nanoseconds>(silent)));
    if (!heard) return true;
    if (centre_next || (first && *centre_first)) zero = heard->pose;
    if (first && *centre_first)
      module.log("the first pose is the zero: the tracker's " + angles_text(heard->pose));
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
