// SPDX-License-Identifier: Apache-2.0
#include <hc/node/module.h>

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include <hc/compress/compress.h>
#include <hc/node/loop.h>

namespace hc {
namespace {

constexpr int kDone = 0, kFailure = 1, kUsage = 2;

int stop_event = -1;  // written by the signal handler
volatile std::sig_atomic_t stop_asked = 0;

extern "C" void ask_to_stop(int) {
  stop_asked = 1;
  std::uint64_t one = 1;
  [[maybe_unused]] auto written = ::write(stop_event, &one, sizeof one);
}

/// A descriptor that becomes readable with SIGINT or SIGTERM. The second signal kills.
int catch_signals() {
  stop_event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return stop_event;
}

/// To a terminal or a pipe of the person who asked; links do not pass here.
void print(int descriptor, std::string_view text) {
  while (!text.empty()) {
    ssize_t size = ::write(descriptor, text.data(), text.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return;  // nobody reads what we have to say
    text.remove_prefix(static_cast<std::size_t>(size));
  }
}

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

std::shared_ptr<ParameterState> Module::add_parameter(std::string name, ParameterValue otherwise,
                                                      std::string unit, std::string doc,
                                                      ParameterOptions options) {
  auto state = std::make_shared<ParameterState>();
  *state = {std::move(name),    std::move(unit), std::move(doc),
            std::move(options), otherwise,       otherwise};
  parameters_.push_back(state);
  return state;
}

void Module::add_pair(std::shared_ptr<internal::InputState> first,
                      std::shared_ptr<internal::InputState> second,
                      std::function<void(const Message&, const Message&)> handler) {
  constexpr std::size_t kMostWaiting = 64;
  auto match = [a = first.get(), b = second.get(), handler = std::move(handler)] {
    while (!a->waiting.empty() && !b->waiting.empty()) {
      std::int64_t a_time = a->waiting.front().header.time, b_time = b->waiting.front().header.time;
      bool together = a_time == b_time || a_time == 0 || b_time == 0;
      if (together) handler(a->waiting.front(), b->waiting.front());
      if (together || a_time < b_time) a->waiting.pop_front();
      if (together || b_time < a_time) b->waiting.pop_front();
    }
  };
  for (auto* input : {first.get(), second.get()}) {
    input->handler = [input, match](const Message& message) {
      input->waiting.push_back(message.keep());
      if (input->waiting.size() > kMostWaiting) input->waiting.pop_front();
      match();
    };
  }
}

void Module::log(std::string_view line) const {
  print(STDERR_FILENO, instance_ + ": " + std::string(line) + "\n");
}

void Module::keep_rate(double rate) {
  auto period = std::chrono::duration_cast<MonotonicTime>(std::chrono::duration<double>(1 / rate));
  MonotonicTime due = next_period_.value_or(clock_.monotonic());
  while (true) {
    MonotonicTime left = due - clock_.monotonic();
    if (left <= MonotonicTime(0)) break;
    auto waited = wait_readable({}, stop_event, std::chrono::ceil<std::chrono::milliseconds>(left));
    if (!waited) throw internal::Stopped();
  }
  // Periods that were missed are not made up for.
  next_period_ = std::max(due, clock_.monotonic() - period) + period;
}

bool internal::stop_requested() {
  return stop_asked != 0;
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
      throw ModuleError(Error{sent.error().code, output.name + ": " + sent.error().detail});
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
    print(STDOUT_FILENO,
          arguments->task == Task::Help ? internal::help(*this) : internal::describe(*this));
    return kDone;
  }
  if (!arguments->instance.empty()) instance_ = arguments->instance;
  int stop = catch_signals();
  try {
    Loop loop(*this, *arguments, stop);
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
