// SPDX-License-Identifier: Apache-2.0
// iceoryx 2.0 with RouDi (scripts/bench_links starts it): untyped endpoints, the publisher waits
// for the consumer. Mode `poll` calls take() until there is a sample; mode `waitset` sleeps in a
// WaitSet where take() gives none. Samples are written in the loaned chunk and read in place; a
// resent one is a loaned chunk that is not written.
#include <iceoryx_posh/popo/untyped_publisher.hpp>
#include <iceoryx_posh/popo/untyped_subscriber.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>

#include <unistd.h>

#include <optional>

#include "../harness.h"

namespace {

using bench::Setup;

iox::capro::ServiceDescription service_of(const Setup& setup) {
  static bool const is_registered = [] {
    std::string name = "hc_bench_" + std::to_string(::getpid());
    iox::runtime::PoshRuntime::initRuntime({iox::cxx::TruncateToCapacity, name});
    return true;
  }();
  static_cast<void>(is_registered);
  return {"hc_bench", "link", {iox::cxx::TruncateToCapacity, setup.link}};
}

iox::popo::PublisherOptions publisher_options() {
  iox::popo::PublisherOptions options;
  options.subscriberTooSlowPolicy = iox::popo::ConsumerTooSlowPolicy::WAIT_FOR_CONSUMER;
  return options;
}

/// A short queue of images keeps their chunks in the cache.
iox::popo::SubscriberOptions subscriber_options(const Setup& setup) {
  iox::popo::SubscriberOptions options;
  options.queueFullPolicy = iox::popo::QueueFullPolicy::BLOCK_PRODUCER;
  options.queueCapacity = setup.is_small() ? 256 : 4;
  return options;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup)
      : bytes_(setup.bytes), publisher_(service_of(setup), publisher_options()) {}

  void await_readers() override {
    while (!publisher_.hasSubscribers()) ::usleep(1000);
  }

  std::span<std::byte> loan() override {
    publisher_.loan(static_cast<std::uint32_t>(bytes_))
        .and_then([&](void* chunk) { chunk_ = chunk; })
        .or_else([](auto) { bench::fail("iceoryx lends no chunk"); });
    return {static_cast<std::byte*>(chunk_), bytes_};
  }

  void publish() override { publisher_.publish(chunk_); }

 private:
  std::size_t bytes_;
  void* chunk_ = nullptr;
  iox::popo::UntypedPublisher publisher_;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup)
      : sleeps_(setup.mode == "waitset"),
        subscriber_(service_of(setup), subscriber_options(setup)) {
    if (sleeps_) {
      wait_set_.emplace();
      wait_set_->attachState(subscriber_, iox::popo::SubscriberState::HAS_DATA).or_else([](auto) {
        bench::fail("iceoryx attaches no subscriber");
      });
    }
  }
  ~Subscriber() override {
    if (wait_set_) wait_set_->detachState(subscriber_, iox::popo::SubscriberState::HAS_DATA);
  }

  void await_writer() override {
    while (subscriber_.getSubscriptionState() != iox::SubscribeState::SUBSCRIBED) ::usleep(1000);
  }

  std::span<const std::byte> receive() override {
    if (chunk_ != nullptr) subscriber_.release(chunk_);
    chunk_ = nullptr;
    bench::Spin spin;
    while (true) {
      subscriber_.take().and_then([&](const void* chunk) { chunk_ = chunk; });
      if (chunk_ != nullptr) break;
      if (sleeps_)
        wait_set_->wait();
      else
        spin();
    }
    const auto* header = iox::mepoo::ChunkHeader::fromUserPayload(chunk_);
    return {static_cast<const std::byte*>(chunk_), header->userPayloadSize()};
  }

 private:
  bool sleeps_;
  const void* chunk_ = nullptr;
  iox::popo::UntypedSubscriber subscriber_;
  std::optional<iox::popo::WaitSet<>> wait_set_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
