// SPDX-License-Identifier: Apache-2.0
#include <hosts/hosts.h>

#include <cmath>
#include <map>
#include <set>

#include <hc/base/clock.h>
#include <hc/base/format.h>
#include <hosts/answer.h>
#include <hosts/connection.h>
#include <hosts/key_file.h>
#include <tls/key.h>

namespace hc::hosts {
namespace {

class AllHosts final : public Hosts {
 public:
  AllHosts(std::string version, std::unique_ptr<internal::Loop> loop)
      : version_(std::move(version)), loop_(std::move(loop)) {}
  AllHosts(const AllHosts&) = delete;
  AllHosts& operator=(const AllHosts&) = delete;
  ~AllHosts() override {
    close_those_not_open();
    for (const auto& [name, host] : hosts_) host->close();
  }

  /// Before anything else: the key is every module's, of whose links any may be to a host that is
  /// declared later.
  Status make_key() {
    auto text = tls::make_key_text();
    if (!text) return text.error();
    auto fingerprint = tls::fingerprint_of_text(*text);
    if (!fingerprint) return fingerprint.error();
    auto file = make_key_file(*text);
    if (!file) return file.error();
    fingerprint_ = *fingerprint;
    key_ = std::move(*file);
    return {};
  }

  std::vector<Result<Connected>> connect(const std::vector<GraphHost>& declared,
                                         int stop) override {
    auto connected = answer_of<std::vector<Result<Connected>>>(
        *loop_, stop, std::chrono::hours(1), [this, declared](const auto& give) {
          auto begun = std::make_shared<Begun>(Begun{{}, declared.size(), give});
          for (std::size_t i = 0; i < declared.size(); ++i)
            begun->connected.emplace_back(Error{Code::Closed, "not connected"});
          for (std::size_t i = 0; i < declared.size(); ++i) begin_connecting(declared[i], i, begun);
          if (declared.empty()) give({});
        });
    if (connected) return *connected;
    loop_->post([this] { close_those_not_open(); });
    return {declared.size(), connected.error()};
  }
  Status serve(const std::function<void()>& work) override {
    bool is_done = false;
    auto aside = internal::run_aside(
        *loop_,
        [&work](int) {
          work();
          return true;
        },
        [&](bool) { is_done = true; });
    if (!aside) return aside.error();
    while (!is_done)
      if (auto turned = loop_->turn(); !turned) return turned;
    return {};
  }

  [[nodiscard]] std::shared_ptr<Host> find(const std::string& name) const override {
    const auto found = hosts_.find(name);
    return found == hosts_.end() ? nullptr : found->second;
  }
  [[nodiscard]] internal::Loop& loop() override { return *loop_; }
  [[nodiscard]] std::string fingerprint() const override { return fingerprint_; }
  [[nodiscard]] int key() const override { return key_.get(); }
  [[nodiscard]] int descriptor() const override { return changed_.descriptor(); }
  std::vector<std::string> take_events() override {
    changed_.clear();
    return std::exchange(events_, {});
  }

 private:
  struct Begun {
    std::vector<Result<Connected>> connected;
    std::size_t missing;
    Give<std::vector<Result<Connected>>> give;

    void note(std::size_t index, Result<Connected> one) {
      connected[index] = std::move(one);
      if (--missing == 0) give(std::move(connected));
    }
  };

  void begin_connecting(const GraphHost& declared, std::size_t index,
                        const std::shared_ptr<Begun>& begun) {
    if (!clock_) look_at_clock();  // with the first host
    const auto known = hosts_.find(declared.name);
    if (known != hosts_.end() && known->second->is_of(declared))
      return begun->note(index, Connected{known->second, known->second->place()});
    auto key = tls::make_key_text();
    if (!key) return begun->note(index, key.error());
    auto fingerprint = tls::fingerprint_of_text(*key);
    if (!fingerprint) return begun->note(index, fingerprint.error());
    const auto host = std::make_shared<Connection>(
        *loop_, Connection::Parts{declared, version_, *key, *fingerprint,
                                  [this](const std::string& line) { log(line); },
                                  [this] { changed_.raise(); }});
    opening_.insert(host);
    host->open([this, index, begun, name = declared.name,
                opening = std::weak_ptr(host)](const Status& opened) {
      const auto self = opening.lock();
      opening_.erase(self);
      if (!opened) return begun->note(index, opened.error());
      auto& entry = hosts_[name];
      if (entry) entry->close();  // the file says something else of it now
      entry = self;
      begun->note(index, Connected{self, self->place()});
    });
  }

  void close_those_not_open() {
    for (const auto& host : std::exchange(opening_, {})) host->close();
  }

  void log(const std::string& line) {
    constexpr std::size_t kMost = 1000;
    if (events_.size() < kMost) events_.push_back(line);
    changed_.raise();
  }

  /// Notices that the clock of this host is set.
  void look_at_clock() {
    const auto wall_offset = monotonic_to_wall();
    if (wall_offset_ && std::abs(wall_offset - *wall_offset_) > kClockSet)
      log(hc::format("graph: the clock of this host was set by {:.3f} s",
                     seconds(wall_offset - *wall_offset_)));
    wall_offset_ = wall_offset;
    clock_ =
        loop_->call_at(std::chrono::steady_clock::now() + kHeartbeat, [this] { look_at_clock(); });
  }

  const std::string version_;
  std::string fingerprint_;
  internal::Descriptor key_;
  const std::unique_ptr<internal::Loop> loop_;
  internal::Event changed_ = internal::Event::must_make();
  std::vector<std::string> events_;
  std::map<std::string, std::shared_ptr<Connection>> hosts_;
  std::set<std::shared_ptr<Connection>> opening_;
  std::optional<std::int64_t> wall_offset_;
  internal::Loop::Handle clock_;
};

}  // namespace

Result<std::unique_ptr<Hosts>> make_hosts(std::string version) {
  auto loop = internal::Loop::make();
  if (!loop) return loop.error();
  auto hosts = std::make_unique<AllHosts>(std::move(version), std::move(*loop));
  if (auto made = hosts->make_key(); !made) return made.error();
  return std::unique_ptr<Hosts>(std::move(hosts));
}

}  // namespace hc::hosts
