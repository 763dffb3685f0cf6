// SPDX-License-Identifier: Apache-2.0
#include <web/graph_client.h>

#include <exception>
#include <utility>

namespace hc::web {

GraphClient::GraphClient(RunningGraph graph, Post post, Callbacks callbacks)
    : graph_(std::move(graph)),
      post_(std::move(post)),
      callbacks_(std::move(callbacks)),
      listener_([this] { survive([this] { listen(); }); }),
      asker_([this] { survive([this] { work(); }); }) {}

GraphClient::~GraphClient() {
  {
    const std::lock_guard lock(mutex_);
    is_stopped_ = true;
  }
  stop_.raise();
  asked_.notify_one();
  listener_.join();
  asker_.join();
}

void GraphClient::command(std::string command, Answered answered) {
  constexpr std::size_t kMaxCommands = 256;
  const std::lock_guard lock(mutex_);
  if (commands_.size() >= kMaxCommands)
    return post_([answered = std::move(answered)] {
      answered({"256 commands are waiting already; try again later"});
    });
  commands_.push_back({std::move(command), std::move(answered)});
  asked_.notify_one();
}

/// What fails, for want of memory, is the end of the graph for the page, and not of the program.
void GraphClient::survive(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception&) {
    post_([this] { callbacks_.end(); });
  }
}

void GraphClient::listen() {
  LinkOptions options;
  options.limits.element_bytes = kMaxStateBytes;
  options.stop = stop_.descriptor();
  auto source = open_source(parse_uri(graph_.state_uri()).value(), options);
  Message message;
  while (source) {
    const auto got = (*source)->take(message);
    if (!got || *got == Got::End) break;
    if (*got == Got::Message)
      post_([this, kept = message.keep()] { callbacks_.message(kept); });
    else if (!(*source)->wait(stop_.descriptor()))
      return;  // stopped
  }
  post_([this] { callbacks_.end(); });
}

void GraphClient::work() {
  while (true) {
    std::unique_lock lock(mutex_);
    asked_.wait(lock, [&] { return is_stopped_ || !commands_.empty(); });
    if (is_stopped_) return;
    auto [command, answered] = std::move(commands_.front());
    commands_.pop_front();
    lock.unlock();
    const auto answer = hc::ask(graph_, {command}, stop_.descriptor());
    std::vector<std::string> rows;
    if (!answer)
      rows = {answer.error().detail};
    else
      rows = answer->rows;
    if (answer && answer->is_ok) rows.insert(rows.begin(), "ok");
    post_([answered = std::move(answered), rows = std::move(rows)] { answered(rows); });
  }
}

}  // namespace hc::web
