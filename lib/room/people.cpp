// SPDX-License-Identifier: Apache-2.0
#include <room/people.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <hc/base/check.h>
#include <room/pointing.h>
#include <room/progress.h>
#include <room/sounds.h>

namespace hc::room {

namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNearest = 1.95, kBetweenLanes = 0.5;  // of lanes [m]
constexpr double kNeck = 1.3;                           // largest turn of a head [rad]
const Vector3d kFaceOfNeck(0.085, 0, 0.1);              // [m]
constexpr TurnTimes kTalking{1.5, 4, 0.3, 0.8};
constexpr TurnTimes kShowing{2 * kRise + 1.8, 2 * kRise + 2.6, 0.8, 1.5};

bool is_any(const std::string& kind, std::initializer_list<const char*> of) {
  return std::ranges::find(of, kind) != of.end();
}

Sign sign_shown(const std::string& kind) {
  if (kind == "palm") return Sign::Open;
  if (kind == "thumb") return Sign::Thumb;
  if (kind == "fist") return Sign::Fist;
  if (kind == "victory") return Sign::Victory;
  return kind == "point" ? Sign::Point : Sign::Relaxed;
}

/// Puts the head on a body, turned to a direction in the world.
///
/// @param nod  > 0 is down [rad].
void turn_head(Person& person, double heading, double direction, double nod) {
  const double turn = std::clamp(direction - heading, -kNeck, kNeck);
  person.T_world_face =
      person.T_world_body *
      Translation3d(Vector3d(0, 0, look_of(person.number).tall - kFaceOfNeck.z())) *
      AngleAxisd(turn, Vector3d::UnitZ()) * AngleAxisd(nod, Vector3d::UnitY()) *
      Translation3d(kFaceOfNeck);
}

void let_hang(Person& person) {
  for (const int side : {kLeft, kRight})
    person.hands[static_cast<std::size_t>(side)] = {
        Sign::Relaxed, person.T_world_body * hanging(look_of(person.number), side)};
}

Person placed(int number, const Vector2d& place, double heading) {
  Person person;
  person.number = number;
  person.T_world_body =
      Translation3d(place.x(), place.y(), 0) * Isometry3d(AngleAxisd(heading, Vector3d::UnitZ()));
  let_hang(person);
  return person;
}

/// Moves a hand from where it hangs to a pose. @param share  of the way, 0 … 1.
void raise(Person& person, int side, Sign sign, const Isometry3d& T_world_wrist, double share) {
  Hand& hand = person.hands[static_cast<std::size_t>(side)];
  const Isometry3d from = hand.T_world_wrist;
  // Bent forward on the way, as the upper arm and the forearm are.
  const Vector3d forward =
      0.12 * std::sin(std::numbers::pi * share) * person.T_world_body.linear().col(0);
  const Vector3d place =
      from.translation() + share * (T_world_wrist.translation() - from.translation()) + forward;
  const Eigen::Quaterniond begin(from.linear()), end(T_world_wrist.linear());
  hand.T_world_wrist = Translation3d(place) * begin.slerp(share, end);
  if (share > 0.5) hand.sign = sign;
}

}  // namespace

People::People(const PeopleMotion& motion)
    : motion_(motion),
      walk_(is_any(motion.kind, {"walk", "cross", "wave"})),
      sign_(sign_shown(motion.kind)),
      turns_(std::max(motion.count, 1), motion.kind == "talk" ? kTalking : kShowing,
             motion.seed * 31 + 7) {
  HC_CHECK(motion.count >= 0 && motion.count <= kMostPeople, motion.count);
  Chance chance(motion.seed);
  for (int i = 0; i < motion.count; ++i) {
    const bool is_whole = motion.kind == "cross";
    const double first =
        is_whole ? (i % 2 == 0 ? kWalkEnd : -kWalkEnd) : chance.next(-kWalkEnd, kWalkEnd);
    const auto seed = static_cast<std::uint64_t>(chance.next() * 1e9);
    walks_.emplace_back(Lane{kNearest + i * kBetweenLanes, first, is_whole, seed});
    const double middle = (i - (motion.count - 1) / 2.0) * 0.95;
    const double y = middle + chance.next(-0.12, 0.12), x = chance.next(2.2, 2.55);
    places_.emplace_back(x, y);
  }
}

std::vector<Person> People::at(double t) {
  std::vector<Person> people;
  for (int i = 0; i < motion_.count; ++i) {
    people.push_back(walk_ ? walking(i, t) : standing(i));
    act(people.back(), t);
  }
  return people;
}

Person People::standing(int number) const {
  const Vector2d& place = places_[static_cast<std::size_t>(number)];
  const double heading = towards_robot(place);
  Person person = placed(number, place, heading);
  turn_head(person, heading, heading, 0.03);
  return person;
}

Person People::walking(int number, double t) {
  const auto step = walks_[static_cast<std::size_t>(number)].at(t);
  Person person = placed(number, step.place, step.heading);
  person.speed = step.speed;
  person.way = step.way;
  turn_head(person, step.heading, towards_robot(step.place), 0.03);
  if (motion_.kind != "wave") return person;
  // From the elbow, three times in two seconds; never still.
  const double swing = 0.45 * std::sin(2 * std::numbers::pi * 1.5 * (t + 0.2 * number));
  const Look& look = look_of(number);
  Isometry3d wave = shown(look, kRight, Sign::Open);
  wave.translation() += Vector3d(0, -0.06 + kForearm * std::sin(swing), 0.06);
  wave.linear() = AngleAxisd(-swing, Vector3d::UnitX()) * wave.linear();
  raise(person, kRight, Sign::Open, person.T_world_body * wave, 1);
  return person;
}

void People::act(Person& person, double t) {
  const auto turn = turns_.at(t);
  if (!turn || turn->person != person.number) return;
  const Vector2d place = person.T_world_body.translation().head<2>();
  const double facing = towards_robot(place);
  if (motion_.kind == "talk") {
    person.speaks = true;
    const double nod = 0.04 * std::sin(2 * std::numbers::pi * 1.3 * (t - turn->begin)) *
                       ease((t - turn->begin) / kRise) * ease((turn->end - t) / kRise);
    turn_head(person, facing, facing, 0.03 + nod);
  }
  if (sign_ == Sign::Relaxed) return;
  const double share = ease((t - turn->begin) / kRise) * ease((turn->end - t) / kRise);
  if (sign_ != Sign::Point) {
    // With both hands of each of two persons, who take turns.
    const int side = turn->number / 2 % 2 == 0 ? kRight : kLeft;
    return raise(person, side, sign_,
                 person.T_world_body * shown(look_of(person.number), side, sign_), share);
  }
  const auto seed = motion_.seed * 1000 + static_cast<std::uint64_t>(turn->number);
  const Vector3d thing = thing_to_point_at(person, Chance(seed).next());
  const int side = pointing_side(person, thing);
  raise(person, side, sign_, pointing_wrist(person, side, thing), share);
  if (share >= 1) person.pointed = thing;
}

double People::voice_of(int person, double t) {
  constexpr double kFade = 0.03;  // [s]
  if (motion_.kind != "talk" || t < 0) return 0;
  const auto turn = turns_.at(t);
  if (!turn || turn->person != person) return 0;
  return ease((t - turn->begin) / kFade) * ease((turn->end - t) / kFade) *
         voice(look_of(person).pitch, t - turn->begin);
}

Vector3d mouth_of(const Person& person) {
  return person.T_world_face * Vector3d(0.015, 0, -0.068);
}

}  // namespace hc::room
