// SPDX-License-Identifier: Apache-2.0
// How long each neural network takes for an image, on one core and on all.
#include <benchmark/benchmark.h>

#include <string>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include <nets/network.h>
#include <nets/weights.h>

namespace {

void run(benchmark::State& state, const std::string& name) {
  const auto network = hc::nets::Network::read(hc::nets::weights_path(name));
  if (!network) {
    state.SkipWithError(network.error().text().c_str());
    return;
  }
  cv::setNumThreads(state.range(0) == 1 ? 1 : cv::getNumberOfCPUs());
  const auto& input = (*network)->input();
  cv::Mat image(input[0], input[1], CV_32FC(input[2]));
  cv::randu(image, 0, 1);
  for ([[maybe_unused]] auto _ : state) {
    auto outputs = (*network)->run(image);
    benchmark::DoNotOptimize(outputs);
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* name :
       {"face_detection_short_range.tflite", "face_detection_full_range.tflite",
        "palm_detection_lite.tflite", "hand_landmark_lite.tflite", "face_recognition.json"})
    benchmark::RegisterBenchmark(name, run, std::string(name))
        ->ArgName("cores")
        ->Arg(1)
        ->Arg(cv::getNumberOfCPUs())
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
