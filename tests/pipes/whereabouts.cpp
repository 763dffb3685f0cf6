// SPDX-License-Identifier: Apache-2.0
// A module for frames_test.py: tells where a frame was at the time of each message, as soon as that
// is known.
#include <deque>

#include <frames/messages.h>
#include <hc/module/module.h>

int main(int argc, char** argv) {
  hc::Module module{"whereabouts", "Tells where a frame was at the times of messages."};
  auto when = module.input("when", hc::anything(), "messages whose times are asked for");
  auto poses = module.input(
      "frames", hc::any_of(hc::transformation<double>(4, 4), hc::transformation<float>(4, 4)),
      "poses of the frames that move");
  auto text = module.parameter("frames", "", "", "the graph's frames, filled in by hc run",
                               {.fixed = true});
  auto gap = module.parameter("gap", 1.0, "s", "between poses further apart nothing is known",
                              {.min = 1e-9, .max = 1e9, .fixed = true});
  auto target = module.parameter("target", "world", "", "the frame that points are wanted in");
  auto source = module.parameter("source", "left_eye", "", "the frame that they are given in");
  auto pose = module.output("pose", hc::transformation<double>(4, 4), "T_target_source");

  hc::frames::GraphFrames frames;
  std::deque<std::int64_t> asked;  // [ns], in the order they came
  auto answer = [&](std::int64_t time) {
    auto T_target_source =
        frames.tree.lookup(std::string_view(*target), std::string_view(*source), time);
    if (!T_target_source) return module.log(T_target_source.error().detail);
    auto draft = pose.loan(4, 4);
    hc::as_eigen<double>(draft) = T_target_source->matrix();
    draft.header.time = time;
    pose.send(std::move(draft));
  };
  // What is asked for a time to come waits for it.
  auto answer_known = [&] {
    auto known = frames.tree.known(std::string_view(*target), std::string_view(*source));
    for (; known && !asked.empty() && asked.front() <= known->last; asked.pop_front())
      answer(asked.front());
  };
  module.on_start([&] {
    const hc::frames::Memory memory{
        .gap = std::chrono::nanoseconds(static_cast<std::int64_t>(*gap * 1e9))};
    frames = hc::value_or_end(hc::frames::read_frames(*text, memory));
  });
  module.on(poses, [&](const hc::Message& message) {
    if (auto fed = hc::feed(frames, message); !fed) module.log(fed.error().detail);
    answer_known();
  });
  module.on(when, [&](const hc::Message& message) {
    asked.push_back(message.header.time);
    answer_known();
  });
  module.on_end([&] {
    for (auto time : asked) answer(time);
  });
  return module.run(argc, argv);
}
