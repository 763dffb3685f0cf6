// SPDX-License-Identifier: Apache-2.0
// A module for frames_test.py: where a frame was at the time of each message, as soon as that is
// known.
#include <frames/messages.h>
#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"whereabouts", "Gives where a frame was at the times of messages."};
  auto when = module.input("when", hc::anything(), "messages whose times are asked for");
  auto target = module.parameter("target", "world", "", "the frame that points are wanted in");
  auto source = module.parameter("source", "left_eye", "", "the frame that they are given in");
  auto pose = module.output("pose", hc::transformation(), "T_target_source");
  constexpr std::chrono::seconds kTimeout{60};
  hc::ModuleFrames frames{module, {.silence = kTimeout, .first = kTimeout}};

  module.on(when, [&](const hc::Message& message) {
    const auto time = message.header.time;
    frames.when_known(*target, *source, time, [&, time](const auto& T_target_source) {
      if (!T_target_source) return module.log(T_target_source.error().detail);
      auto draft = pose.loan(4, 4);
      hc::as_eigen<double>(draft) = T_target_source->matrix();
      draft.header.time = time;
      pose.send(std::move(draft));
    });
  });
  module.on_end([&] { frames.answer_all(); });
  return module.run(argc, argv);
}
