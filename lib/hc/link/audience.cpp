// SPDX-License-Identifier: Apache-2.0
#include <hc/link/audience.h>

#include <array>
#include <cstdlib>
#include <utility>

#include <hc/os/descriptor.h>

namespace hc::internal {

Status wait_for_event(int descriptor, LinkOptions& options, TimePoint until) {
  auto& [interrupter, call] = options.interrupt;
  std::array<pollfd, 3> polled = {
      {{descriptor, POLLIN, 0}, {interrupter, POLLIN, 0}, {options.stop, POLLIN, 0}}};
  HC_TRY(poll_until(polled, until));
  if (polled[2].revents != 0) return Error{Code::Stopped, "asked to stop"};
  if (polled[1].revents != 0 && !call()) interrupter = -1;
  return {};
}

Result<Audience> Audience::make(const Uri& uri, std::int64_t most, const Policy& policy,
                                const LinkOptions& options) {
  Audience made;
  made.readers_ = HC_TRY(number_option(uri, "readers", -1, {0, most}));
  made.stays_ = HC_TRY(number_option(uri, "stay", 0, {0, 1})) == 1;
  made.writer_waits_ = policy.writer_waits();
  made.arrival_ =
      Patience(std::chrono::seconds(HC_TRY(number_option(uri, "wait", 0))), {}, options.log);
  made.absence_ = Patience(policy.timeout, {}, options.log);
  return made;
}

Audience::Fate Audience::decide(std::size_t present) {
  const bool is_complete = present >= static_cast<std::size_t>(std::abs(readers_));
  if (!has_begun_ && !is_complete && !arrival_.is_over()) return Fate::Kept;
  const bool was_begun = std::exchange(has_begun_, true);
  if (present > 0) {
    arrival_.renew();
    absence_.renew();
    return Fate::Sent;
  }
  if (was_begun && ends_with_readers()) return Fate::End;
  const bool goes_on = readers_ == 0 || arrival_.is_over() || absence_.is_over() || !writer_waits_;
  return goes_on ? Fate::Lost : Fate::Kept;
}

void Audience::count_lost(Traffic& traffic) const {
  ++traffic.messages;
  ++(absence_.is_over() ? traffic.dropped_timeout : traffic.dropped_disconnect);
}

Status Audience::await(int descriptor, LinkOptions& options,
                       const std::function<Result<std::size_t>()>& present) {
  const auto wanted = has_begun_ ? 1 : static_cast<std::size_t>(std::abs(readers_));
  auto now_present = present();
  const bool waits = now_present && *now_present < wanted;
  if (waits && options.awaits_reader) options.awaits_reader(true);
  Status outcome;
  auto& patience = has_begun_ ? absence_ : arrival_;
  while (outcome && now_present && *now_present < wanted &&
         patience.waits(0, std::chrono::steady_clock::now())) {
    outcome = wait_for_event(descriptor, options, patience.due());
    if (outcome) now_present = present();
  }
  patience.end();
  if (waits && options.awaits_reader) options.awaits_reader(false);
  return now_present ? outcome : Status(now_present.error());
}

}  // namespace hc::internal
