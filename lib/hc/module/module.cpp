// SPDX-License-Identifier: Apache-2.0
#include <hc/module/module.h>

#include <unistd.h>

#include <algorithm>
#include <new>
#include <utility>

#include <hc/base/visible.h>
#include <hc/module/loop.h>
#include <hc/module/run.h>
#include <hc/os/program.h>

namespace hc {
namespace {

const SystemClock kSystemClock;

}  // namespace

/// OpenCV says "OpenCV(4.6.0) ./x.cpp:73: error: (-4:Insufficient memory) … in function 'y'".
std::string internal::thrown_in_words(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "System: not enough memory";
  std::string text = error.what();
  if (text.starts_with("OpenCV(")) {
    const auto begin = text.find("error: ");
    if (begin != std::string::npos) text.erase(0, begin + 7);
    text = "System: OpenCV: " + text.substr(0, text.find(" in function "));
  }
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

Module::Module(std::string name, std::string summary, const ModuleOptions& options)
    : name_(std::move(name)),
      summary_(std::move(summary)),
      instance_(name_),
      options_(options),
      clock_(options.clock != nullptr ? *options.clock : kSystemClock) {
  prepare_program();
}

Module::~Module() = default;

std::shared_ptr<internal::InputState> Module::add_input(std::string name,
                                                        std::vector<PortType> types,
                                                        std::string doc,
                                                        const InputOptions& options) {
  auto state = std::make_shared<internal::InputState>();
  state->options = options;
  state->name = std::move(name);
  state->types = std::move(types);
  state->doc = std::move(doc);
  state->is_finite = std::any_of(state->types.begin(), state->types.end(),
                                 [](const auto& type) { return type.finite; });
  inputs_.push_back(state);
  return state;
}

std::shared_ptr<internal::OutputState> Module::add_output(std::string name,
                                                          std::vector<PortType> types,
                                                          std::string doc,
                                                          const OutputOptions& options) {
  auto state = std::make_shared<internal::OutputState>();
  state->options = options;
  state->name = std::move(name);
  state->types = std::move(types);
  state->doc = std::move(doc) + (options.on_demand ? "; only by a link of its own" : "");
  state->module = this;
  outputs_.push_back(state);
  state->address = static_cast<std::int32_t>(outputs_.size());
  return state;
}

std::shared_ptr<ParameterState> Module::add_parameter(std::string name,
                                                      const ParameterValue& default_value,
                                                      std::string unit, std::string doc,
                                                      ParameterOptions options) {
  auto state = std::make_shared<ParameterState>();
  *state = {std::move(name),    std::move(unit), std::move(doc),
            std::move(options), default_value,   default_value};
  parameters_.push_back(state);
  return state;
}

void Module::add_together(const std::vector<std::shared_ptr<internal::InputState>>& inputs,
                          Matcher::Take handler) {
  const auto index = together_.size();
  auto take = [this, index](std::span<const Message> set) {
    internal::TogetherState& state = *together_[index];
    if (!state.set.empty()) ++state.dropped_newer;
    state.set.assign(set.begin(), set.end());
    if (!state.is_latest) handle(state);
  };
  together_.push_back(std::make_unique<internal::TogetherState>(internal::TogetherState{
      inputs, std::move(handler), Matcher(inputs.size(), std::move(take)), false, {}}));
  internal::TogetherState& state = *together_.back();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    internal::InputState& input = *inputs[i];
    HC_CHECK(!input.handler, input.name);
    input.together = &state;
    input.place = i;
    input.handler = [this, &state, i](Message& message) {
      state.matcher.push(i, message.owner != nullptr ? std::move(message) : message.keep());
      log_unmatched(state);
    };
  }
}

void Module::handle(internal::TogetherState& together) {
  if (is_done_ || together.set.empty()) return;
  const auto set = std::exchange(together.set, {});
  const Header& latest = std::max_element(set.begin(), set.end(), [](const auto& a, const auto& b) {
                           return a.header.time < b.header.time;
                         })->header;
  handled_ = internal::Handled(latest);
  if (std::any_of(set.begin(), set.end(), [&](const auto& each) {
        return each.header.coord != latest.coord || each.header.info.type != latest.info.type;
      }))
    handled_.coord = 0;
  auto note_each = [&](TraceEvent::What what) {
    for (std::size_t i = 0; i < set.size(); ++i)
      loop_->note(what, together.inputs[i]->name, set[i].header);
  };
  note_each(TraceEvent::What::Began);
  together.handler(set);
  note_each(TraceEvent::What::Ended);
  handled_ = {};
}

void Module::log_unmatched(internal::TogetherState& together) {
  const bool is_starving = together.matcher.is_starving();
  if (std::exchange(together.is_starving, is_starving) != is_starving) {
    std::string names;
    for (const auto& input : together.inputs) names += (names.empty() ? "" : ", ") + input->name;
    if (is_starving)
      log(names + ": no messages of equal time for " + std::to_string(Matcher::kStarving.count()) +
              " s: none is handled",
          Level::Warning);
    else
      log(names + ": messages of equal time again");
  }
  // Where sets are dropped for newer ones, that is no news.
  if (together.is_latest && together.dropped_newer > 0) return;
  for (const auto& input : together.inputs)
    if (!input->is_unmatched && together.matcher.dropped(input->place).total() > 0) {
      input->is_unmatched = true;
      log(input->name + ": dropped: no matching message (further drops are counted)");
    }
}

void Module::log(std::string_view line, Level level) const {
  if (level != Level::Info && management_ != nullptr &&
      management_->send(Report::Log, make_log(level, line), clock_.wall()))
    return;
  const std::string prefix = level == Level::Info ? "" : std::string(hc::name(level)) + ": ";
  // There is no one to tell that it failed.
  static_cast<void>(write_all(STDERR_FILENO, instance_ + ": " + prefix + visible(line) + "\n"));
}

void Module::log_once(const std::string& kind, std::string_view line, std::int64_t count) {
  std::int64_t& logged = logged_[kind];
  if (std::exchange(logged, logged + count) == 0)
    log(std::string(line) + " (further ones are counted, not logged)");
}

void Module::log_counts() const {
  std::string counts;
  for (const auto& [kind, count] : logged_)
    counts += (counts.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  if (!counts.empty()) log("total: " + counts);
}

Timeout Module::after(std::chrono::nanoseconds duration, std::function<void()> handler) {
  // Those that can fire no more.
  std::erase_if(timeouts_, [](const auto& each) { return each.use_count() == 1 && !each->due; });
  timeouts_.push_back(
      std::make_shared<Timeout::State>(Timeout::State{*this, duration, std::move(handler), {}}));
  Timeout timeout(timeouts_.back());
  timeout.restart();
  return timeout;
}

void Timeout::restart() {
  restart(state_->duration);
}

void Timeout::restart(std::chrono::nanoseconds duration) {
  // Before the start there is no time: it is then counted from it.
  const auto now = state_->module.loop_ != nullptr ? state_->module.monotonic() : MonotonicTime(0);
  state_->due = now + std::clamp(duration, MonotonicTime(0), internal::kLongestPeriod);
}

void ModuleAccess::report_focus(Module& module, std::int32_t mode, const Stops& stops) {
  auto& focus = module.focus_;
  const bool is_new = focus.decided != mode || focus.stops != stops;
  focus.decided = mode;
  focus.stops = stops;
  if (is_new && module.loop_ != nullptr) module.loop_->report_state();
}

Time Module::now() const {
  if (loop_ != nullptr) return loop_->read_clock();
  return message_time_ ? *message_time_ : clock_.wall();
}

MonotonicTime Module::monotonic() const {
  const Time wall = now();  // is traced
  return message_time_ ? wall.time_since_epoch() : clock_.monotonic();
}

void Module::keep_rate(double rate) {
  auto period = [&] { return internal::period_of(rate); };
  loop_->pause([&] { return last_period_ ? *last_period_ + period() : MonotonicTime(0); });
  // Periods that were missed are not made up for.
  auto now = monotonic();
  last_period_ = std::max(last_period_ ? *last_period_ + period() : now, now - period());
}

void Module::wait_until(MonotonicTime time) {
  if (time > monotonic()) loop_->pause([=] { return time; });
}

bool Module::is_read() const {
  for (const auto& output : outputs_)
    for (const auto& link : output->links)
      if (link->sink != nullptr) return true;
  return false;
}

int Module::run(int argc, char** argv) {
  Run run(*this, {argv + 1, argv + argc});
  run.work();
  return run.end();
}

}  // namespace hc
