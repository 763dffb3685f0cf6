// SPDX-License-Identifier: Apache-2.0
// `shm:NAME`: opens both ends, a ShmSink (sink.h) or a ShmSource (source.h).
#include <algorithm>

#include <hc/link/paced_source.h>
#include <hc/link/shm/crash_point.h>
#include <hc/link/shm/sink.h>
#include <hc/link/shm/source.h>
#include <hc/link/stream/ends.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

/// About as long as it takes to sleep and wake up, so that spinning at most doubles the cost.
constexpr std::int64_t kDefaultSpin = 20;  // [µs]

/// How a reader connects.
struct Wishes {
  std::uint64_t keep;  ///< or kPublishersKeep
  std::chrono::microseconds spin;
  bool waits;  ///< for the publisher's answer; else take() receives it later
  std::shared_ptr<const Descriptor> wakes;
};

/// Makes the reader of a connected publisher. Errors: as await_offer().
Result<std::unique_ptr<Source>> attach(Descriptor socket, const Wishes& wishes,
                                       const LinkOptions& options) {
  auto attachment = std::make_shared<Attachment>();
  attachment->socket = std::move(socket);
  attachment->page = HC_TRY(SharedMemory::make(kPageBytes, kPageBytes));
  HC_CRASH_POINT("reader made page");
  const int connection = attachment->socket.get();
  HC_TRY(send_hello(connection, wishes.keep, attachment->page, wishes.wakes->get()));
  auto source = std::make_unique<ShmSource>(attachment, wishes.wakes, wishes.spin, options);
  if (wishes.waits) {
    auto offer = HC_TRY(await_offer(connection, options.stop));
    source->attach(std::move(offer));
  }
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace

Status check_shm_memory(const Uri& uri) {
  const auto policy = HC_TRY(parse_policy(uri));
  if (policy.memory >= kLeastMemory) return {};
  return Error{Code::Invalid, "memory is at least " + std::to_string(kLeastMemory) +
                                  " bytes where it is shared, not " +
                                  std::to_string(policy.memory)};
}

Result<std::unique_ptr<Sink>> open_shm_sink(const Uri& uri, const LinkOptions& options) {
  HC_TRY(check_name(uri));
  HC_TRY(check_shm_memory(uri));
  auto policy = HC_TRY(parse_policy(uri));
  auto audience = HC_TRY(Audience::make(uri, kMostReaders, policy, options));
  auto socket = HC_TRY(listen_unix(meeting_place(uri)));
  auto memory = HC_TRY(SharedMemory::make(policy.memory / kPageBytes * kPageBytes, kSlotsBegin));
  auto sink = std::make_unique<ShmSink>(std::move(memory), audience, policy, options);
  HC_TRY(sink->begin(std::move(socket)));
  return std::unique_ptr<Sink>(std::move(sink));
}

Result<std::unique_ptr<Source>> open_shm_source(const Uri& uri, const LinkOptions& options) {
  HC_TRY(check_name(uri));
  auto spin = HC_TRY(number_option(uri, "spin", kDefaultSpin));
  auto reconnect = HC_TRY(number_option(uri, "reconnect", 0));
  auto policy = HC_TRY(parse_policy(uri));
  std::uint64_t keep = kPublishersKeep;
  if (!uri.option("keep", "").empty())
    keep = policy.writer_waits() ? 0 : std::min<std::uint64_t>(policy.keep, kPublishersKeep - 1);
  auto wakes = HC_TRY(make_wake_pipe());
  const Wishes wishes{keep, std::chrono::microseconds(spin), reconnect == 0, std::move(wakes)};
  Uri place = meeting_place(uri);
  auto peer = HC_TRY(unix_peer(place));
  peer.name = uri.rest;
  auto open = [wishes, options](ConnectedSocket connection) {
    return attach(std::move(connection.descriptor), wishes, options);
  };
  auto source = HC_TRY(dial_source(peer, uri, options, {open, wishes.wakes->get()}));
  return make_paced(std::move(source), policy);
}

}  // namespace hc::internal
