// SPDX-License-Identifier: Apache-2.0
#include <graph/load.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include <hc/os/descriptor.h>
#include <hc/os/event.h>
#include <hc/os/loop.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

/// Host "a" is unreachable, all others do not answer.
class FakeHosts final : public Hosts {
 public:
  [[nodiscard]] Loop& loop() override { return *loop_; }
  Status serve(const std::function<void()>& work) override {
    work();
    return {};
  }
  Result<Connected> connect(const GraphHost& declared, int stop) override {
    if (declared.name == "a") return Error{Code::Closed, "no route"};
    if (asked) asked();
    HC_TRY(wait_for(stop, 0, stop));
    return Error{Code::Closed, "it never ends"};
  }
  [[nodiscard]] std::shared_ptr<Host> find(const std::string&) const override { return nullptr; }
  [[nodiscard]] std::string fingerprint() const override { return ""; }
  [[nodiscard]] int key() const override { return -1; }
  [[nodiscard]] int descriptor() const override { return -1; }
  std::vector<std::string> take_events() override { return {}; }

  std::function<void()> asked;

 private:
  const std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
};

class Load : public ::testing::Test {
 protected:
  ~Load() override { ::unlink(options_.file.c_str()); }

  Result<LoadedGraph> load() { return make_loader(options_)->load(nullptr, stop_.descriptor()); }
  /// Writes a graph with a module on each host.
  void write(const std::vector<std::string>& hosts) const {
    std::ofstream file(options_.file);
    file << "version = 1\n";
    for (const auto& host : hosts)
      file << "[hosts." << host << "]\nssh = \"" << host << "\"\n[modules.on_" << host
           << "]\nprogram = \"camera\"\nhost = \"" << host << "\"\n";
  }

  FakeHosts hosts_;
  const Plan running_{};
  const Event stop_ = must(Event::make());
  LoadOptions options_ = [this] {
    LoadOptions options;
    options.token = graph_token();
    options.file = ::testing::TempDir() + options.token + ".toml";
    options.hosts = &hosts_;
    return options;
  }();
};

TEST_F(Load, AFileThatHangsIsNotWaitedForWhenStopped) {
  ASSERT_EQ(::mkfifo(options_.file.c_str(), S_IRUSR | S_IWUSR), 0);
  stop_.raise();
  EXPECT_EQ(refused(load()).code, Code::Stopped);
  // Unblocks the abandoned thread.
  const Descriptor writer(::open(options_.file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
}

TEST_F(Load, AFileThatIsThereAndCannotBeReadIsNotMissing) {
  auto code = [&] { return refused(make_loader(options_)->load(&running_, -1)).code; };
  EXPECT_EQ(code(), Code::NotFound);
  ASSERT_EQ(::symlink("/", options_.file.c_str()), 0);
  EXPECT_EQ(code(), Code::System);
  ::unlink(options_.file.c_str());
  ASSERT_EQ(::symlink("/proc/self/mem", options_.file.c_str()), 0);  // reading it fails
  EXPECT_EQ(code(), Code::System);
  ::unlink(options_.file.c_str());
  ASSERT_EQ(::mkfifo(options_.file.c_str(), S_IRUSR | S_IWUSR), 0);
  EXPECT_EQ(code(), Code::System);
}

TEST_F(Load, AHostThatFailsIsSaidThoughAnotherDoesNotAnswer) {
  write({"a", "b"});
  const auto loaded = must(load());
  EXPECT_EQ(loaded.problems, std::vector<std::string>{options_.file + ":2: host a: no route"});
}

TEST_F(Load, AHostThatDoesNotAnswerIsNotWaitedForWhenStopped) {
  write({"b"});
  hosts_.asked = [this] { stop_.raise(); };
  const auto loaded = must(load());
  EXPECT_EQ(loaded.problems, std::vector<std::string>{"Stopped: asked to stop"});
}

TEST_F(Load, ARecorderThatIsNotLookedForIsNotMissing) {
  write({"b"});
  options_.recorder = {{"to", "kept"}};
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  hosts_.asked = [&] {
    const rlimit none_more{3, before.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none_more);
    stop_.raise();
  };
  const auto loaded = load();
  ::setrlimit(RLIMIT_NOFILE, &before);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->problems,
            (std::vector<std::string>{"Stopped: asked to stop",
                                      "--record: eventfd(): Too many open files"}));
}

}  // namespace
}  // namespace hc
