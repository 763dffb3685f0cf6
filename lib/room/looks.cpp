// SPDX-License-Identifier: Apache-2.0
#include <room/looks.h>

#include <hc/base/check.h>

namespace hc::room {

namespace {

// Places of the photographed face [m].
const Eigen::Vector2d kEye(0.0315, 0), kNose(0, -0.036), kMouth(0, -0.068), kHairline(0, 0.025);

std::vector<Look> make_looks() {
  Look first;
  first.clothes = {60, 78, 120};
  first.trousers = {52, 54, 62};
  first.tall = 1.58;
  first.pitch = 205;

  Look second;
  second.wide = 1.07;
  second.high = 1.08;
  second.jaw = 1.05;
  second.warps = {{kHairline, 0.035, {1, 2.16}, {0, 0.0087}},
                  {kNose, 0.018, {1.6, 0.93}, {0, 0.004}},
                  {kMouth, 0.023, {1.3, 1.5}, {0, 0.004}},
                  {kEye, 0.014, {0.78, 0.7}, {0.0018, -0.003}}};
  second.skin = {0.82, 1.27, {1.12, 0.72, 0.5}};
  second.hair = {0.95, 2.2, {0.5, 0.45, 0.42}};
  second.beard = 0.85;
  second.brows = 0.9;
  second.clothes = {128, 52, 46};
  second.trousers = {60, 58, 50};
  second.tall = 1.72;
  second.pitch = 110;

  Look third;
  third.wide = 0.88;
  third.high = 1.08;
  third.jaw = 1.1;
  third.warps = {{kHairline, 0.035, {1, 1.78}, {0, 0.0058}},
                 {kNose, 0.018, {0.7, 1.14}, {0, -0.0053}},
                 {kMouth, 0.023, {0.7, 0.77}, {0, 0.004}},
                 {kEye, 0.014, {1.25, 1.12}, {-0.004, 0.0022}}};
  third.skin = {0.2, 1.1, {1.1, 0.92, 0.86}};
  third.hair = {1, 0.6, {0.88, 0.9, 0.93}};
  third.glasses = true;
  third.brows = 0.9;
  third.clothes = {70, 112, 84};
  third.trousers = {92, 84, 74};
  third.tall = 1.66;
  third.pitch = 150;
  return {first, second, third};
}

}  // namespace

const Look& look_of(int person) {
  static const std::vector<Look> kLooks = make_looks();
  HC_CHECK(person >= 0 && person < kMostPeople, person);
  return kLooks[static_cast<std::size_t>(person)];
}

}  // namespace hc::room
