// SPDX-License-Identifier: Apache-2.0
// The way from an eye to the world beside the same products and one interpolation written out.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include <frames/tree.h>

namespace {

using hc::frames::Pose;

constexpr hc::Time kBegin{std::chrono::seconds(1763683200)};
constexpr std::chrono::nanoseconds kStep = std::chrono::milliseconds(10);
constexpr int kPoses = 1000;  // 10 s at 100 Hz

Eigen::Isometry3d motion(int i) {
  Eigen::Isometry3d result =
      Eigen::Translation3d(0.1, 0.2, 0.3) * hc::frames::rotation(0, 0.001 * i, 0.002 * i);
  return result;
}

hc::frames::Tree example() {
  auto tree = hc::frames::Tree::standard();
  auto joined = tree.fix("world", "robot", motion(1));
  if (joined) joined = tree.join("robot", "head");
  if (joined) joined = tree.fix("head", "left_eye", motion(2));
  HC_CHECK(joined.has_value());
  for (int i = 0; i < kPoses; ++i)
    HC_CHECK(tree.feed("robot", "head", kBegin + i * kStep, motion(i)).has_value());
  return tree;
}

/// Times between poses, all over what is known.
hc::Time next_time(std::chrono::nanoseconds& state) {
  state = (state + std::chrono::nanoseconds(7'919'000'003)) % (kPoses * kStep - kStep);
  return kBegin + state;
}

template <typename Name>
void look_up(benchmark::State& state, Name to, Name from) {
  auto tree = example();
  std::chrono::nanoseconds at{0};
  for ([[maybe_unused]] auto _ : state) {
    auto found = tree.lookup(to, from, next_time(at));
    benchmark::DoNotOptimize(found);
  }
}

void frames_lookup_by_name(benchmark::State& state) {
  look_up<const char*>(state, "world", "left_eye");
}
BENCHMARK(frames_lookup_by_name);

void frames_lookup_by_number(benchmark::State& state) {
  look_up(state, 1, 4);
}
BENCHMARK(frames_lookup_by_number);

void frames_lookup_reference(benchmark::State& state) {
  std::vector<hc::Time> times;
  std::vector<Pose> poses;
  for (int i = 0; i < kPoses; ++i) {
    times.push_back(kBegin + i * kStep);
    poses.emplace_back(motion(i));
  }
  Eigen::Isometry3d T_world_robot = motion(1), T_head_left_eye = motion(2);
  std::chrono::nanoseconds at{0};
  for ([[maybe_unused]] auto _ : state) {
    hc::Time time = next_time(at);
    auto i = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) -
                                      times.begin());
    double share = hc::seconds(time - times[i - 1]) / hc::seconds(kStep);
    Eigen::Isometry3d T_robot_head =
        Eigen::Translation3d((1 - share) * poses[i - 1].p + share * poses[i].p) *
        poses[i - 1].q.slerp(share, poses[i].q);
    Eigen::Isometry3d T_world_left_eye = T_world_robot * T_robot_head * T_head_left_eye;
    benchmark::DoNotOptimize(T_world_left_eye);
  }
}
BENCHMARK(frames_lookup_reference);

void frames_feed(benchmark::State& state) {
  auto tree = example();
  hc::Time time = kBegin + kPoses * kStep;
  Eigen::Isometry3d pose = motion(3);
  for ([[maybe_unused]] auto _ : state) {
    auto fed = tree.feed(2, 3, time += kStep, pose);
    benchmark::DoNotOptimize(fed);
  }
}
BENCHMARK(frames_feed);

}  // namespace
