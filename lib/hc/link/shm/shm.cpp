// SPDX-License-Identifier: Apache-2.0
// `shm:NAME`: how either end is opened; sink.h and source.h are what is opened.
#include <hc/link/paced_sink.h>
#include <hc/link/shm/crash_point.h>
#include <hc/link/shm/sink.h>
#include <hc/link/shm/source.h>
#include <hc/link/stream/awaiting_source.h>
#include <hc/link/stream/dialing.h>
#include <hc/link/stream/unix.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

/// About as long as it takes to sleep and wake: who spins so long never loses more than that.
constexpr std::int64_t kDefaultSpin = 20;  // [µs]

/// How a reader attaches.
struct Wishes {
  std::string keep;  ///< empty: as the publisher wants it
  std::chrono::microseconds spin;
  bool waits;  ///< for the publisher's answer, or else take() does without
};

/// Makes the reader of a publisher that has been connected to. Errors: as await_offer().
Result<std::unique_ptr<Source>> attach(Descriptor socket, const Wishes& wishes,
                                       const LinkOptions& options) {
  auto attachment = std::make_shared<Attachment>();
  attachment->socket = std::move(socket);
  auto page = SharedMemory::make(kPageBytes, kPageBytes);
  if (!page) return page.error();
  attachment->page = std::move(*page);
  HC_CRASH_POINT("reader made page");
  const int connection = attachment->socket.get();
  if (auto sent = send_hello(connection, wishes.keep, attachment->page); !sent) return sent.error();
  auto begin = [attachment, spin = wishes.spin, options](Offer offer) -> std::unique_ptr<Source> {
    attachment->memory = std::move(offer.memory);
    attachment->own().cursor.store(offer.begin, std::memory_order_release);
    return std::make_unique<ShmSource>(attachment, offer, spin, options);
  };
  if (!wishes.waits)
    return std::unique_ptr<Source>(std::make_unique<AwaitingSource>(
        connection, [connection, begin]() -> Result<std::unique_ptr<Source>> {
          auto offer = take_offer(connection);
          if (!offer) return offer.error();
          return offer->has_value() ? begin(std::move(**offer)) : nullptr;
        }));
  auto offer = await_offer(connection, options.stop);
  if (!offer) return offer.error();
  return begin(std::move(*offer));
}

}  // namespace

Status check_shm_memory(const Uri& uri) {
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  if (policy->memory >= kLeastMemory) return {};
  return Error{Code::Invalid, "memory is at least " + std::to_string(kLeastMemory) +
                                  " bytes where it is shared, not " +
                                  std::to_string(policy->memory)};
}

Result<std::unique_ptr<Sink>> open_shm_sink(const Uri& uri, const LinkOptions& options) {
  if (auto named = check_name(uri); !named) return named.error();
  auto counted = number_option(uri, "readers", 0, kMostReaders);
  if (!counted) return counted.error();
  auto stays = number_option(uri, "stay", 0, 1);
  if (!stays) return stays.error();
  if (auto enough = check_shm_memory(uri); !enough) return enough.error();
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  auto socket = listen_unix(meeting_place(uri));
  if (!socket) return socket.error();
  auto memory = SharedMemory::make(policy->memory / kPageBytes * kPageBytes, kSlotsBegin);
  if (!memory) return memory.error();
  auto remarks = std::make_shared<Remarks>();
  LinkOptions own = options;
  if (policy->is_paced())  // it sends on the thread that serves links too
    own.log = [remarks](Severity, std::string_view line) { remarks->add(std::string(line)); };
  auto sink = std::make_unique<ShmSink>(std::move(*memory), *counted, *stays == 1,
                                        policy->writer_waits() ? 0 : policy->keep, std::move(own));
  if (auto begun = sink->begin(std::move(*socket)); !begun) return begun.error();
  return make_paced(std::move(sink), *policy, options, std::move(remarks));
}

Result<std::unique_ptr<Source>> open_shm_source(const Uri& uri, const LinkOptions& options) {
  if (auto named = check_name(uri); !named) return named.error();
  auto spin = number_option(uri, "spin", kDefaultSpin);
  if (!spin) return spin.error();
  auto reconnect = number_option(uri, "reconnect", 0);
  if (!reconnect) return reconnect.error();
  Wishes wishes{std::string(uri.option("keep", "")), std::chrono::microseconds(*spin),
                *reconnect == 0};
  if (!wishes.keep.empty())
    if (auto valid = parse_keep(wishes.keep); !valid) return valid.error();
  Uri place = meeting_place(uri);
  auto peer = unix_peer(place);
  if (!peer) return peer.error();
  peer->name = uri.rest;
  return dial_source(*peer, uri, options, [wishes, options](Descriptor socket) {
    return attach(std::move(socket), wishes, options);
  });
}

}  // namespace hc::internal
