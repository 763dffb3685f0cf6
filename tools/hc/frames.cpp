// SPDX-License-Identifier: Apache-2.0
// hc frames: prints the transform between two frames of a graph.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <numbers>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <hc/compress/compress.h>
#include <hc/os/program.h>
#include <hc/os/wait_readable.h>

#include "common.h"
#include "graph.h"
#include "graph_recording.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

namespace fs = std::filesystem;
using hc::frames::GraphFrames;

constexpr std::chrono::seconds kPatience{5};  // without a pose

struct FramesOptions {
  hc::LoadOptions graph;
  std::string source, target, recording, of;
  std::int64_t time = 0;  // [ns]; 0: latest
};

void feed(GraphFrames& frames, const hc::Message& message, const std::string& output) {
  const auto plain = value_or_fail(hc::expand(message), output);
  value_or_fail(hc::feed(frames, plain), output);
}

/// The outputs that move frames on the chain between the two.
std::vector<std::string> outputs_between(const GraphFrames& frames, const FramesOptions& options) {
  const auto chain =
      value_or_fail(frames.tree.chain(options.target, options.source), options.graph.file);
  auto is_between = [&](const std::string& frame) {
    return std::find(chain.begin(), chain.end(), frame) != chain.end();
  };
  std::vector<std::string> outputs;
  for (const auto& mover : frames.movers)
    if (is_between(mover.child) && is_between(mover.parent) &&
        std::find(outputs.begin(), outputs.end(), mover.output) == outputs.end())
      outputs.push_back(mover.output);
  return outputs;
}

void read_recording(GraphFrames& frames, const std::string& place,
                    const std::vector<std::string>& outputs) {
  const GraphRecording recording(place);
  for (const auto& output : outputs) {
    auto source = recording.open(output);
    for (hc::Message message; recording.receive(*source, message, output);)
      feed(frames, message, recording.place_of(output));
  }
}

/// The running graph whose outputs move the frames.
RunningGraph choose_graph(const FramesOptions& options, const std::vector<std::string>& outputs) {
  const auto stem = fs::path(options.graph.file).stem().string();
  try {
    return choose_running(options.of.empty() ? stem : options.of);
  } catch (const Failure& failure) {
    throw Failure(failure.code,
                  hc::format("{}; {} to {} depends on {}: run the graph (--of NAME if it has "
                             "another name), or give a recording with --in FOLDER",
                             failure.detail, options.source, options.target, joined(outputs)));
  }
}

/// Takes poses of a running graph until the transform is known, or none has come for kPatience;
/// then the lookup reports what is missing.
void observe(GraphFrames& frames, const FramesOptions& options,
             const std::vector<std::string>& outputs) {
  const auto graph = choose_graph(options, outputs);
  std::vector<std::unique_ptr<hc::Source>> sources;
  std::vector<int> descriptors;
  for (const auto& output : outputs) {
    sources.push_back(open_port(graph, output));
    descriptors.push_back(sources.back()->descriptor());
  }
  auto is_known = [&] {
    return options.time > 0
               ? !frames.tree.is_ahead(options.target, options.source, hc::unix_time(options.time))
               : frames.tree.known(options.target, options.source).has_value();
  };
  using Clock = std::chrono::steady_clock;
  auto heard = Clock::now();
  hc::Message message;
  while (true) {
    for (std::size_t i = 0; i < sources.size(); ++i)
      for (; value_or_fail(sources[i]->take(message), outputs[i]) == hc::Got::Message;
           heard = Clock::now())
        feed(frames, message, outputs[i]);
    if (is_known() || Clock::now() - heard > kPatience) return;
    value_or_fail(hc::wait_readable(descriptors, hc::stop_descriptor(), kPatience));
  }
}

std::string text_of(const GraphFrames& frames, const FramesOptions& options) {
  const auto known = frames.tree.known(options.target, options.source);
  const bool is_fixed = known && *known == hc::frames::TimeSpan{};
  const auto time = options.time > 0 || !known ? hc::unix_time(options.time)
                    : is_fixed                 ? hc::Time()
                                               : known->last;
  const auto T =
      value_or_fail(frames.tree.lookup(options.target, options.source, time), options.graph.file);
  auto row = [](std::string_view what, const Eigen::Array3d& exact) {
    const Eigen::Array3d numbers = (exact * 1e4).round() / 1e4 + 0.0;  // not -0
    return hc::format("  {:<28} {:9.4f} {:9.4f} {:9.4f}\n", what, numbers.x(), numbers.y(),
                      numbers.z());
  };
  const Eigen::Matrix3d R = T.linear();
  const auto chain =
      value_or_fail(frames.tree.chain(options.target, options.source), options.graph.file);
  return hc::format("{} to {}, {}\n", options.source, options.target,
                    is_fixed ? "fixed" : hc::format("at {} ns", hc::unix_nanoseconds(time))) +
         row("translation [m]", T.translation()) + row("rotation", R.row(0)) + row("", R.row(1)) +
         row("", R.row(2)) +
         row("roll, pitch, yaw [degree]", hc::frames::angles_of(R) * (180 / std::numbers::pi)) +
         hc::format("  {:<28} {}\n", "chain", joined(chain, " -> "));
}

void run(const FramesOptions& options) {
  const auto plan = look_at_plan("frames", options.graph);
  // Large enough for a whole recording.
  const hc::frames::Memory memory{.span = std::chrono::hours(24 * 365), .poses = 10'000'000};
  auto frames = value_or_fail(hc::frames::read_frames(plan.frames, memory), options.graph.file);
  const auto outputs = outputs_between(frames, options);
  if (!options.recording.empty())
    read_recording(frames, options.recording, outputs);
  else if (!outputs.empty())
    observe(frames, options, outputs);
  print(text_of(frames, options));
}

}  // namespace

void add_frames(CLI::App& app) {
  auto options = std::make_shared<FramesOptions>();
  auto* verb = app.add_subcommand("frames", "Print where a frame of a graph is in another");
  add_graph_options(*verb, options->graph);
  verb->add_option("source", options->source, "frame in which points are given")->required();
  verb->add_option("target", options->target, "frame in which they are wanted")->required();
  verb->add_option("--at", options->time, "time [ns since 1970] (default: the latest known)")
      ->check(whole_number());
  auto* in = verb->add_option("--in", options->recording,
                              "folder or .mcap of hc run --record (default: the running graph)");
  add_of(*verb, options->of);
  verb->get_option("--of")->excludes(in);
  verb->callback([options] { run(*options); });
}

}  // namespace tool
