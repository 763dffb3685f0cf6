// SPDX-License-Identifier: Apache-2.0
#include <frames/module_frames.h>

#include <algorithm>
#include <utility>

#include <frames/default_head.h>
#include <frames/messages.h>

namespace hc {
namespace {

constexpr std::size_t kMaxWaiting = 256;
constexpr std::chrono::seconds kSetBack{1}, kAhead{1};
constexpr std::chrono::milliseconds kTick{10};

}  // namespace

ModuleFrames::ModuleFrames(Module& module, const Options& options)
    : module_(module),
      options_(options),
      text_(module.parameter("frames", std::string(frames::kDefaultHead), "",
                             "frames of the graph, set by hc run; default: the default head",
                             {.fixed = true})) {
  if (!options.input) return;
  auto poses = module.input("frames", any_of(transformation(), transformation<float>()),
                            "poses of moving frames, T_parent_child [m]; linked by hc run");
  module.on(poses, [this](const Message& message) {
    const auto& header = message.header;
    const auto* mover = value_or_drop(known().mover_of(header.src, header.coord));
    succeed_or_drop(
        feed(mover->parent, mover->child, header.time, value_or_drop(rigid_of(message))));
  });
  module.every(kTick, [this] {
    silence_ += kTick;
    answer_known();
  });
}

ModuleFrames::Name::Name(const frames::Frame& frame) {
  if (const auto* of = std::get_if<std::int32_t>(&frame))
    number = *of;
  else
    name = std::get<std::string_view>(frame);
}

ModuleFrames::Name::operator frames::Frame() const {
  if (name.empty()) return number;
  return std::string_view(name);
}

frames::GraphFrames& ModuleFrames::known() {
  if (!frames_) frames_ = value_or_refuse(text_, frames::read_frames(*text_, options_.memory));
  return *frames_;
}

Eigen::Isometry3d ModuleFrames::nearest(const frames::Frame& target, const frames::Frame& source,
                                        Time time) {
  return value_or_refuse(text_, tree().nearest(target, source, given(time)));
}

Eigen::Isometry3d ModuleFrames::fixed(const frames::Frame& target, const frames::Frame& source) {
  const auto span = value_or_refuse(text_, tree().known(target, source));
  if (span != frames::TimeSpan{}) refuse(text_, "a joint moves where a fixed one is expected");
  return value_or_refuse(text_, lookup(target, source, Time()));
}

Status ModuleFrames::feed(std::string_view parent, std::string_view child, Time time,
                          const Eigen::Isometry3d& T_parent_child) {
  auto& newest = newest_.emplace(child, time).first->second;
  if (time < newest - kSetBack) {
    known().tree.forget();
    newest_.clear();
    last_ = {};
  } else {
    newest = std::max(newest, time);
  }
  last_ = std::max(last_, time);
  fed_ = module_.now();
  silence_ = {};
  HC_TRY(known().tree.feed(parent, child, time, T_parent_child));
  answer_known();
  return {};
}

bool ModuleFrames::awaits(const frames::Frame& target, const frames::Frame& source, Time time) {
  const Time wanted = given(time);
  return fed_ > Time() && silence() < options_.silence &&
         wanted - kAhead <= std::max(module_.now(), last_) &&
         tree().is_ahead(target, source, wanted);
}

// After a long handler, poses wait in the input: it is counted in ticks, between which they are
// taken.
std::chrono::nanoseconds ModuleFrames::silence() const {
  return options_.input ? silence_ : module_.now() - fed_;
}

bool ModuleFrames::is_awaited(const Waiting& waiting) {
  if (!tree().is_ahead(waiting.target, waiting.source, waiting.time)) return false;
  const auto now = module_.now();
  const bool is_first = fed_ == Time() && now - waiting.since < options_.first;
  return is_first || awaits(waiting.target, waiting.source, waiting.time);
}

void ModuleFrames::when_known(const frames::Frame& target, const frames::Frame& source, Time time,
                              Handler handler) {
  waiting_.push_back({Name(target), Name(source), given(time), module_.now(), std::move(handler)});
  answer_known();
}

void ModuleFrames::answer_known() {
  while (!waiting_.empty() && (waiting_.size() > kMaxWaiting || !is_awaited(waiting_.front()))) {
    const Waiting first = std::move(waiting_.front());
    waiting_.pop_front();
    first.handler(lookup(first.target, first.source, first.time));
  }
}

void ModuleFrames::answer_all() {
  options_.silence = options_.first = {};
  answer_known();
}

}  // namespace hc
