// SPDX-License-Identifier: Apache-2.0
#include <web/visitor.h>

#include <algorithm>
#include <future>
#include <map>
#include <string_view>
#include <utility>

namespace hc::web {

namespace {

constexpr std::size_t kMaxKnown = 768;

}  // namespace

Status Shared::aside(Work work) {
  using Then = std::function<void()>;
  const auto place = asides.emplace(asides.end());
  const auto kept = std::make_shared<Work>(std::move(work));
  auto begun = run_aside(
      *loop,
      [kept](int) {
        std::packaged_task<Then()> task(std::ref(*kept));
        auto then = task.get_future();
        task();
        return then;
      },
      [this, place, kept](std::future<Then> then) {
        asides.erase(place);
        guard([&] { then.get()(); });
      });
  if (begun) {
    std::swap(*place, *begun);
    return {};
  }
  // Never run it on this thread: while it waits for a disk, a stop could not arrive.
  asides.erase(place);
  return Error{Code::System, "the server is too busy for this (" + begun.error().detail +
                                 "); try again in a moment"};
}

Visitor::Visitor(std::shared_ptr<Shared> shared, Peer peer)
    : shared_(std::move(shared)), peer_(std::move(peer)) {
  shared_->strangers.push_back(this);
}

Visitor::~Visitor() {
  if (is_known_)
    --shared_->known;
  else
    std::erase(shared_->strangers, this);
}

bool Visitor::know() {
  if (is_known_) return true;
  if (shared_->known >= kMaxKnown) return false;
  std::erase(shared_->strangers, this);
  ++shared_->known;
  return is_known_ = true;
}

bool Visitor::drop_one(Shared& shared) {
  std::map<std::string_view, std::size_t> counts;
  for (const auto* stranger : shared.strangers) ++counts[stranger->peer_.name];
  std::size_t most = 0;
  for (const auto& [source, count] : counts) most = std::max(most, count);
  const auto oldest = std::ranges::find_if(
      shared.strangers, [&](const auto* each) { return counts[each->peer_.name] == most; });
  if (oldest == shared.strangers.end()) return false;
  const auto close = (*oldest)->close;
  shared.strangers.erase(oldest);
  if (close) close();
  return true;
}

}  // namespace hc::web
