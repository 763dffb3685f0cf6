// SPDX-License-Identifier: Apache-2.0
#include <hc/node/module.h>

#include <unistd.h>

#include <algorithm>

#include <hc/base/program.h>
#include <hc/compress/compress.h>
#include <hc/node/loop.h>

namespace hc {
namespace {

constexpr int kDone = 0, kFailure = 1, kUsage = 2;

}  // namespace

Module::Module(std::string name, std::string summary)
    : name_(std::move(name)), summary_(std::move(summary)), instance_(name_) {}

Module::~Module() = default;

std::shared_ptr<internal::InputState> Module::add_input(std::string name,
                                                        std::vector<PortType> types,
                                                        std::string doc) {
  auto state = std::make_shared<internal::InputState>();
  state->name = std::move(name);
  state->types = std::move(types);
  state->doc = std::move(doc);
  inputs_.push_back(state);
  return state;
}

std::shared_ptr<internal::OutputState> Module::add_output(std::string name, PortType type,
                                                          std::string doc) {
  auto state = std::make_shared<internal::OutputState>();
  state->name = std::move(name);
  state->type = type;
  state->doc = std::move(doc);
  state->module = this;
  outputs_.push_back(state);
  state->address = static_cast<std::int32_t>(outputs_.size());
  return state;
}

std::shared_ptr<ParameterState> Module::add_parameter(std::string name,
                                                      const ParameterValue& otherwise,
                                                      std::string unit, std::string doc,
                                                      ParameterOptions options) {
  auto state = std::make_shared<ParameterState>();
  *state = {std::move(name),    std::move(unit), std::move(doc),
            std::move(options), otherwise,       otherwise};
  parameters_.push_back(state);
  return state;
}

void Module::add_together(const std::vector<std::shared_ptr<internal::InputState>>& inputs,
                          const Matching& how, Matcher::Take handler) {
  auto take = [this, handler = std::move(handler)](std::span<const Message> set) {
    const Header& latest =
        std::max_element(set.begin(), set.end(), [](const auto& a, const auto& b) {
          return a.header.time < b.header.time;
        })->header;
    handled_time_ = latest.time;
    handled_mode_ = latest.mode;
    handler(set);
    handled_time_ = 0;
  };
  together_.push_back(std::make_unique<internal::TogetherState>(
      internal::TogetherState{inputs, Matcher(inputs.size(), how, std::move(take))}));
  internal::TogetherState& state = *together_.back();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    internal::InputState& input = *inputs[i];
    HC_CHECK(!input.handler, input.name);
    input.matcher = &state.matcher;
    input.place = i;
    input.handler = [this, &state, i](const Message& message) {
      state.matcher.push(i, message.keep());
      tell_left_out(state);
    };
  }
}

void Module::tell_left_out(const internal::TogetherState& together) const {
  for (const auto& input : together.inputs)
    if (!input->told && together.matcher.left_out(input->place).total() > 0) {
      input->told = true;
      log(input->name + ": a message has no partner and is left out, as others may be");
    }
}

void Module::log(std::string_view line) const {
  // Who cannot be told anything is not told so either.
  static_cast<void>(write_all(STDERR_FILENO, instance_ + ": " + std::string(line) + "\n"));
}

void Module::keep_rate(double rate) {
  auto period = std::chrono::duration_cast<MonotonicTime>(std::chrono::duration<double>(1 / rate));
  MonotonicTime due = next_period_.value_or(clock_.monotonic());
  while (true) {
    MonotonicTime left = due - clock_.monotonic();
    if (left <= MonotonicTime(0)) break;
    auto waited =
        wait_readable({}, stop_descriptor(), std::chrono::ceil<std::chrono::milliseconds>(left));
    if (!waited) throw internal::Stopped();
  }
  // Periods that were missed are not made up for.
  next_period_ = std::max(due, clock_.monotonic() - period) + period;
}

void internal::send(OutputState& output, Message message) {
  Module& module = *output.module;
  Header& header = message.header;
  header.src = output.address;
  header.seq = output.seq++;
  header.mode = module.handled_mode_;
  if (header.coord == 0) header.coord = output.type.coord;
  if (header.time == 0) header.time = module.handled_time_;
  auto wanted = output.encoding.value_or(output.type.info.encoding);
  if (message.plain() && (wanted == Encoding::Text || wanted == Encoding::Binary))
    header.info.encoding = wanted;  // the same in memory
  else
    message = value_or_end(compress(message, wanted));
  bool any_left = false;
  for (auto& link : output.links) {
    if (link->sink == nullptr) continue;
    auto sent = link->sink->send(message);
    if (!sent && sent.error().code == Code::Stopped) throw Stopped();
    if (!sent && sent.error().code != Code::Closed)
      throw ModuleError(
          Error{sent.error().code, (sent.error().code == Code::NotFound ? link->uri : output.name) +
                                       ": " + sent.error().detail});
    if (!sent) {
      link->traffic = link->sink->traffic();
      link->sink.reset();
      any_left = true;
    }
  }
  if (any_left && !module.is_read()) throw Stopped();
}

bool Module::is_read() const {
  for (const auto& output : outputs_)
    for (const auto& link : output->links)
      if (link->sink != nullptr) return true;
  return false;
}

int Module::run(int argc, char** argv) {
  auto arguments = internal::parse_arguments(*this, {argv + 1, argv + argc});
  if (!arguments) {
    log(arguments.error().text());
    return kUsage;
  }
  using Task = internal::Arguments::Task;
  if (arguments->task != Task::Run) {
    auto printed =
        write_all(STDOUT_FILENO, arguments->task == Task::Help ? internal::help(*this)
                                                               : internal::describe(*this));
    if (printed || printed.error().code == Code::Closed) return kDone;
    log(printed.error().text());
    return kFailure;
  }
  if (!arguments->instance.empty()) instance_ = arguments->instance;
  try {
    Loop loop(*this, *arguments, stop_descriptor());
    try {
      loop.run();
    } catch (const internal::Stopped&) {
      // Its readers have gone, or it was told to stop: a clean end.
    }
    loop.close();
  } catch (const internal::Stopped&) {
    // Told to stop while its links opened or closed.
  } catch (const std::exception& error) {
    log(error.what());
    return kFailure;
  }
  return kDone;
}

}  // namespace hc
