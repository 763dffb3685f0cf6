// SPDX-License-Identifier: Apache-2.0
#include "stop.h"

#include <utility>

template <typename IsSettled, typename Problem>
void Stop::answer(const IsSettled& is_settled, const Problem& problem_of) {
  for (const auto& order : orders_)
    if (is_settled(order)) order.answer(problem_of(order));
  std::erase_if(orders_, is_settled);
}

Stop::Word Stop::order(bool stops, bool is_linked, hc::MonotonicTime now, Answer answer_it) {
  is_wanted_ = stops;
  has_cleared_ = !stops;
  answer([&](const Order& before) { return before.stops != stops; },
         [&](const Order& before) {
           return before.stops ? "stop NOT confirmed: it was cleared meanwhile"
                               : "NOT cleared: it was stopped again meanwhile";
         });
  if (is_linked)
    orders_.push_back({stops, now + kPatience, std::move(answer_it)});
  else
    answer_it((stops ? "stop NOT confirmed: nothing is linked to "
                     : "NOT cleared: nothing is linked to ") +
              module_ + ".stop; this graph has no workspace that the page can stop: end the graph");
  return stops ? Word::Stop : Word::Clear;
}

void Stop::hear(bool is_stopped, hc::MonotonicTime now) {
  heard_ = is_stopped;
  heard_at_ = now;
  answer([&](const Order& order) { return order.stops == is_stopped; },
         [](const Order&) { return ""; });
}

std::optional<Stop::Word> Stop::tick(std::optional<bool> is_guarded, hc::MonotonicTime now) {
  answer([&](const Order& order) { return now >= order.due; },
         [&](const Order& order) { return problem(order); });
  // The clear sent by order() must not be overtaken by another word.
  const bool has_cleared = std::exchange(has_cleared_, false);
  if (!is_wanted_ && !orders_.empty() && heard_) return Word::Clear;
  if (has_cleared) return std::nullopt;
  if (is_wanted_) return Word::Stop;
  if (!is_guarded) return std::nullopt;
  if (*is_guarded) {
    if (!first_) first_ = now;
    if (now - *first_ < kFirst) return std::nullopt;
    farewells_ = kFarewells;
    return Word::Free;
  }
  if (farewells_ == 0) return std::nullopt;
  --farewells_;
  return Word::Unguarded;
}

std::optional<bool> Stop::is_stopped(hc::MonotonicTime now) const {
  return heard_ && now - heard_at_ < kSilence ? heard_ : std::nullopt;
}

std::string Stop::problem(const Order& order) const {
  const std::string what = order.stops ? "stop NOT confirmed: " : "NOT cleared: ";
  if (!heard_)
    return what + "nothing comes to " + module_ + ".stopped; link it to the workspace's output";
  if (heard_at_ <= order.due - kPatience) return what + "the workspace does not answer";
  return what + (order.stops ? "the workspace says that the robot is not stopped"
                             : "the workspace says that the robot is still stopped");
}
