// SPDX-License-Identifier: Apache-2.0
// How long each neural network takes for an image, on one core and on all, and the search for faces
// in an image of 800 × 600 px: in all of it, and around one face that is followed.
#include <benchmark/benchmark.h>

#include <chrono>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include <nets/network.h>
#include <nets/weights.h>
#include <people/face_search.h>

namespace {

void use_cores(const benchmark::State& state) {
  cv::setNumThreads(state.range(0) == 1 ? 1 : cv::getNumberOfCPUs());
}

void run(benchmark::State& state, const std::string& name) {
  const auto network = hc::nets::Network::read(hc::nets::weights_path(name));
  if (!network) {
    state.SkipWithError(network.error().text().c_str());
    return;
  }
  use_cores(state);
  const auto& input = (*network)->input();
  cv::Mat image(input[0], input[1], CV_32FC(input[2]));
  cv::randu(image, 0, 1);
  for ([[maybe_unused]] auto _ : state) {
    auto outputs = (*network)->run(image);
    benchmark::DoNotOptimize(outputs);
  }
}

/// Without faces, so that nothing is followed.
void search(benchmark::State& state, bool whole) {
  auto faces = hc::people::FaceSearch::read();
  if (!faces) {
    state.SkipWithError(faces.error().text().c_str());
    return;
  }
  use_cores(state);
  cv::Mat image(600, 800, CV_8UC3);
  cv::randu(image, 0, 255);
  hc::Time time{std::chrono::hours(1)};
  for ([[maybe_unused]] auto _ : state) {
    if (whole)
      benchmark::DoNotOptimize(faces->look(time += std::chrono::hours(1), image));
    else
      benchmark::DoNotOptimize(faces->look_around(image, {400, 300, 90, 90}));
  }
}

void measure(benchmark::internal::Benchmark* of) {
  of->ArgName("cores")
      ->Arg(1)
      ->Arg(cv::getNumberOfCPUs())
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* name :
       {"face_detection_short_range.tflite", "face_detection_full_range.tflite",
        "palm_detection_lite.tflite", "hand_landmark_lite.tflite", "face_recognition.json"})
    measure(benchmark::RegisterBenchmark(name, run, std::string(name)));
  measure(benchmark::RegisterBenchmark("faces/whole_image", search, true));
  measure(benchmark::RegisterBenchmark("faces/around_one", search, false));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
