// SPDX-License-Identifier: Apache-2.0
#include <hosts/hosts.h>

#include <cmath>
#include <map>
#include <set>

#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hc/os/aside.h>
#include <hosts/answer.h>
#include <hosts/connection.h>
#include <hosts/key_file.h>
#include <tls/key.h>

namespace hc::hosts {
namespace {

class AllHosts final : public Hosts {
 public:
  AllHosts(std::string version, std::unique_ptr<Loop> loop, Event changed)
      : version_(std::move(version)), loop_(std::move(loop)), changed_(std::move(changed)) {}
  AllHosts(const AllHosts&) = delete;
  AllHosts& operator=(const AllHosts&) = delete;
  ~AllHosts() override {
    close_opening();
    for (const auto& [name, host] : hosts_) host->close();
  }

  /// Call this first: every module gets the key, as it may be linked to hosts declared later.
  Status make_key() {
    const auto text = HC_TRY(tls::make_key_text());
    fingerprint_ = HC_TRY(tls::fingerprint_of_text(text));
    key_ = HC_TRY(make_key_file(text));
    return {};
  }

  Result<Connected> connect(const GraphHost& declared, int stop) override {
    auto connected = answer_of<Connected>(
        *loop_, stop, std::chrono::hours(1),
        [this, declared](const auto& give) { begin_connecting(declared, give); });
    if (!connected && connected.error().code == Code::Stopped)
      loop_->post([this] { close_opening(); });
    return connected;
  }
  Status serve(const std::function<void()>& work) override {
    bool is_done = false;
    const auto aside = HC_TRY(run_aside(
        *loop_, [&work](int) { return work(), true; }, [&](bool) { is_done = true; }));
    while (!is_done) HC_TRY(loop_->turn());
    return {};
  }

  [[nodiscard]] std::shared_ptr<Host> find(const std::string& name) const override {
    const auto found = hosts_.find(name);
    return found == hosts_.end() ? nullptr : found->second;
  }
  [[nodiscard]] Loop& loop() override { return *loop_; }
  [[nodiscard]] std::string fingerprint() const override { return fingerprint_; }
  [[nodiscard]] int key() const override { return key_.get(); }
  [[nodiscard]] int descriptor() const override { return changed_.descriptor(); }
  std::vector<std::string> take_events() override {
    changed_.clear();
    return std::exchange(events_, {});
  }

 private:
  void begin_connecting(const GraphHost& declared, const Give<Connected>& give) {
    if (!clock_) check_clock();  // with the first host
    const auto known = hosts_.find(declared.name);
    if (known != hosts_.end() && known->second->is_of(declared))
      return give(Connected{known->second, known->second->place()});
    auto key = tls::make_key_text();
    auto fingerprint = key ? tls::fingerprint_of_text(*key) : key;
    if (!fingerprint) return give(fingerprint.error());
    const auto host = std::make_shared<Connection>(
        *loop_, Connection::Parts{declared, version_, *key, *fingerprint,
                                  [this](const std::string& line) { log(line); },
                                  [this] { changed_.raise(); }});
    opening_.insert(host);
    host->open([this, give, name = declared.name, host](const Status& opened) {
      opening_.erase(host);
      if (!opened) {
        loop_->post([host] { host->close(); });  // deferred, since the host is the caller
        return give(opened.error());
      }
      auto& entry = hosts_[name];
      if (entry) entry->close();  // its declaration has changed
      entry = host;
      give(Connected{host, host->place()});
    });
  }

  void close_opening() {
    for (const auto& host : std::exchange(opening_, {})) host->close();
  }

  void log(const std::string& line) {
    constexpr std::size_t kMost = 1000;
    if (events_.size() < kMost) events_.push_back(line);
    changed_.raise();
  }

  /// Logs when the clock of this host was set.
  void check_clock() {
    const auto wall_offset = monotonic_to_wall();
    if (wall_offset_ && std::chrono::abs(wall_offset - *wall_offset_) > kClockSet)
      log(hc::format("graph: the clock of this host was set by {:.3f} s",
                     seconds(wall_offset - *wall_offset_)));
    wall_offset_ = wall_offset;
    clock_ =
        loop_->call_at(std::chrono::steady_clock::now() + kHeartbeat, [this] { check_clock(); });
  }

  const std::string version_;
  std::string fingerprint_;
  Descriptor key_;
  const std::unique_ptr<Loop> loop_;
  const Event changed_;
  std::vector<std::string> events_;
  std::map<std::string, std::shared_ptr<Connection>> hosts_;
  std::set<std::shared_ptr<Connection>> opening_;
  std::optional<std::chrono::nanoseconds> wall_offset_;
  Loop::Handle clock_;
};

}  // namespace

Result<std::unique_ptr<Hosts>> make_hosts(std::string version) {
  auto loop = HC_TRY(Loop::make());
  auto changed = HC_TRY(Event::make());
  auto hosts = std::make_unique<AllHosts>(std::move(version), std::move(loop), std::move(changed));
  HC_TRY(hosts->make_key());
  return std::unique_ptr<Hosts>(std::move(hosts));
}

}  // namespace hc::hosts
