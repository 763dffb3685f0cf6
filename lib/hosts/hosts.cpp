// SPDX-License-Identifier: Apache-2.0
#include <hosts/hosts.h>

#include <cmath>
#include <map>
#include <mutex>

#include <hc/base/format.h>
#include <hosts/connection.h>
#include <hosts/key_file.h>
#include <tls/key.h>

namespace hc::hosts {
namespace {

class AllHosts final : public Hosts {
 public:
  explicit AllHosts(std::string version) : version_(std::move(version)) {}
  AllHosts(const AllHosts&) = delete;
  AllHosts& operator=(const AllHosts&) = delete;
  ~AllHosts() override {
    for (const auto& [name, host] : hosts_) host->close();
    if (worker_) worker_->post([this] { clock_.reset(); });
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

  /// Begins with the first host.
  Status begin() {
    if (worker_) return {};
    auto worker = Worker::make();
    if (!worker) return worker.error();
    worker_ = std::move(*worker);
    worker_->post([this] { look_at_clock(); });
    return {};
  }

  std::vector<Result<std::shared_ptr<Host>>> connect(const std::vector<GraphHost>& declared,
                                                     int stop) override {
    std::vector<Result<std::shared_ptr<Connection>>> begun;
    begun.reserve(declared.size());
    for (const auto& each : declared) begun.push_back(begin_connecting(each));
    std::vector<Result<std::shared_ptr<Host>>> hosts;
    for (std::size_t i = 0; i < declared.size(); ++i)
      hosts.push_back(wait(begun[i], declared[i], stop));
    return hosts;
  }

  [[nodiscard]] std::shared_ptr<Host> find(const std::string& name) const override {
    return find_connection(name);
  }
  [[nodiscard]] std::string fingerprint() const override { return fingerprint_; }
  [[nodiscard]] int key() const override { return key_.get(); }
  [[nodiscard]] int descriptor() const override { return changed_.descriptor(); }
  std::vector<std::string> take_events() override {
    changed_.clear();
    const std::lock_guard lock(mutex_);
    return std::exchange(events_, {});
  }

 private:
  Result<std::shared_ptr<Connection>> begin_connecting(const GraphHost& declared) {
    if (auto there = find_connection(declared.name); there && there->is_of(declared)) return there;
    if (auto begun = begin(); !begun) return begun.error();
    auto key = tls::make_key_text();
    if (!key) return key.error();
    auto fingerprint = tls::fingerprint_of_text(*key);
    if (!fingerprint) return fingerprint.error();
    auto host = std::make_shared<Connection>(
        *worker_, Connection::Parts{declared, version_, *key, *fingerprint,
                                    [this](const std::string& line) { log(line); },
                                    [this] { changed_.raise(); }});
    host->open();
    return host;
  }

  Result<std::shared_ptr<Host>> wait(const Result<std::shared_ptr<Connection>>& begun,
                                     const GraphHost& declared, int stop) {
    if (!begun) return begun.error();
    if (find_connection(declared.name) == *begun) return std::shared_ptr<Host>(*begun);
    if (auto opened = (*begun)->wait_until_open(stop); !opened) {
      (*begun)->close();
      return opened.error();
    }
    const std::lock_guard lock(mutex_);
    auto& entry = hosts_[declared.name];
    if (entry) entry->close();  // the file says something else of it now
    entry = *begun;
    return std::shared_ptr<Host>(*begun);
  }

  [[nodiscard]] std::shared_ptr<Connection> find_connection(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    auto found = hosts_.find(name);
    return found == hosts_.end() ? nullptr : found->second;
  }

  void log(const std::string& line) {
    constexpr std::size_t kMost = 1000;
    const std::lock_guard lock(mutex_);
    if (events_.size() < kMost) events_.push_back(line);
    changed_.raise();
  }

  /// Notices that the clock of this host is set.
  void look_at_clock() {
    const auto wall_offset = monotonic_to_wall();
    if (wall_offset_ && std::abs(wall_offset - *wall_offset_) > kClockSet)
      log(hc::format("graph: the clock of this host was set by {:.3f} s",
                     static_cast<double>(wall_offset - *wall_offset_) * 1e-9));
    wall_offset_ = wall_offset;
    clock_ = worker_->loop().call_at(std::chrono::steady_clock::now() + kHeartbeat,
                                     [this] { look_at_clock(); });
  }

  const std::string version_;
  std::string fingerprint_;
  internal::Descriptor key_;
  internal::Event changed_ = internal::Event::must_make();
  mutable std::mutex mutex_;
  std::vector<std::string> events_;
  std::map<std::string, std::shared_ptr<Connection>> hosts_;
  std::optional<std::int64_t> wall_offset_;
  internal::Loop::Handle clock_;
  std::unique_ptr<Worker> worker_;  // ends first
};

}  // namespace

Result<std::unique_ptr<Hosts>> make_hosts(std::string version) {
  auto hosts = std::make_unique<AllHosts>(std::move(version));
  if (auto made = hosts->make_key(); !made) return made.error();
  return std::unique_ptr<Hosts>(std::move(hosts));
}

}  // namespace hc::hosts
