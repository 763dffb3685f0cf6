// SPDX-License-Identifier: Apache-2.0
#pragma once
// Links carry messages in one direction, from a Sink to a Source, over the transport that a URI
// selects; table.cpp lists the transports.
// An object is used on one thread; different objects may be used on different threads.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/base/traffic.h>
#include <hc/base/uri.h>
#include <hc/mtp/message.h>

namespace hc {

class WaitSet;

/// The result of Source::take().
enum class Got {
  Message,  ///< a message
  Nothing,  ///< none yet; WaitSet waits for the next
  End,      ///< no further ones: the peer has closed the link, or the file has ended
};

/// The receiving end of a link.
class Source {
 public:
  Source();
  virtual ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Takes the next message; never blocks. `message` owns or shares its elements; its previous
  /// elements are released in any case.
  ///
  /// Errors: those of StreamReader, Truncated, Closed (the peer has died or vanished), NotFound (no
  /// peer was found), System; the link is then unusable. A listening source closes the failed
  /// connection instead, logs the error, and continues with the others.
  virtual Result<Got> take(Message& message) = 0;

  // Waiting. WaitSet does this for any number of sources; an event loop can do the same.

  /// A descriptor for poll(): readable when take() has work, if prepare_wait() has returned true
  /// since take() returned Nothing. Constant.
  [[nodiscard]] virtual int descriptor() const = 0;

  /// A second descriptor for messages in shared memory, to be watched edge-triggered (EPOLLET) and
  /// never read. Constant; -1: none, descriptor() is sufficient.
  [[nodiscard]] virtual int wake_descriptor() const { return -1; }

  /// Requests a notification of the next message; false if one can be taken already.
  virtual bool prepare_wait() { return true; }

  /// Where to busy-wait before sleeping; valid until the next take().
  struct Spin {
    const std::atomic<std::uint64_t>* word = nullptr;  ///< null: do not busy-wait
    std::uint64_t value = 0;            ///< a message is ready when the word is at least this
    std::chrono::microseconds time{0};  ///< how long
  };
  [[nodiscard]] virtual Spin spin() const { return {}; }

  /// Waits for this source only, as WaitSet does; false after `timeout`.
  ///
  /// Errors: Stopped (`stop` is readable), System.
  Result<bool> wait(int stop = -1,
                    std::chrono::milliseconds timeout = std::chrono::milliseconds(-1));

  /// What take() has returned so far.
  [[nodiscard]] virtual Traffic traffic() const = 0;

  /// The number of connected peers; nullopt if unknown, or not applicable, as for a file.
  [[nodiscard]] virtual std::optional<std::size_t> peers() const { return std::nullopt; }

  /// Announces that the peer will not come back: the link ends with the current connection, or at
  /// once without one. Only sources that reconnect need this.
  virtual void finish() {}

  /// Continues at the next valid header after an error of take() (R40).
  ///
  /// Errors: Unsupported unless the data can be read again, as from a file.
  virtual Status resume() {
    return Error{Code::Unsupported, "only files can be read further after an error"};
  }

 private:
  friend class WaitSet;
  const std::uint64_t number_;      // unique in this process, never reused
  std::unique_ptr<WaitSet> alone_;  // for wait()
};

/// The sending end of a link.
class Sink {
 public:
  virtual ~Sink() = default;

  /// Sends a message. Blocks while the link is full or has no reader yet; with `keep` other than
  /// all, it does not wait for slow readers.
  ///
  /// Errors: Closed (the reader disconnected, or abandon() was called), NotFound (no reader was
  /// found), Stopped (LinkOptions::stop became readable before the first byte was sent), Truncated
  /// (it did so later, and the reader did not take the rest within 2 s; the link is then unusable),
  /// System.
  virtual Status send(const Message& message) = 0;

  /// A message to be filled in place and sent: in shared memory if the transport has it, else on
  /// the heap. Sending it through another sink copies it. A header that check() refuses is a bug.
  virtual Draft loan(const Header& header) { return Draft::make(header); }

  /// Ends the link: the reader gets End after the last message. Errors as send().
  virtual Status close() = 0;

  /// Ends the link without waiting: messages that have not reached a reader are lost and counted
  /// (Traffic::dropped_disconnect), except those in memory shared with it. Nothing can be sent
  /// afterwards.
  virtual void abandon() {}

  /// Whether a message has not been handed over completely: its pace, the network or the reader is
  /// slower than what is sent. False for memory that readers share.
  [[nodiscard]] virtual bool is_behind() const { return false; }

  /// What send() has accepted so far; a message to several readers counts once.
  [[nodiscard]] virtual Traffic traffic() const = 0;

  /// As Source::peers(); accepts waiting readers. Not to be called within send().
  virtual std::optional<std::size_t> peers() { return std::nullopt; }
};

/// Options of a link that do not depend on the transport.
struct LinkOptions {
  Limits limits;  ///< for received messages
  /// Takes a line, beginning with the URI, when a connection is made or fails; called on the
  /// threads that use the link's end. May be empty.
  LogSink log;
  int stop = -1;  ///< descriptor that ends waits when it is readable; -1: none
  /// Work for a sink while it waits for a reader or for room.
  struct Interrupt {
    int descriptor = -1;  ///< `call` is called when it is readable; -1: never
    /// Called on the sending thread; may abandon() the sink. False: do not call it again.
    std::function<bool()> call;
  } interrupt = {};
  /// Called with true on the sending thread when a sink waits for a reader to connect, or has
  /// waited long for one to take a message, and with false afterwards. May be empty.
  std::function<void(bool awaits)> awaits_reader = {};
};

/// Opens the receiving or the sending end of a link. doc/links.md lists the URIs and their options.
///
/// Errors: Invalid (an unknown scheme or option, or a bad value), NotFound (no such file or host),
/// Closed (connection refused), Stopped, System (name in use, …).
Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options = {});
Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options = {});

/// Checks the URI of a source or a sink as far as possible without opening it.
///
/// Errors: Invalid.
Status check_source(const Uri& uri);
Status check_sink(const Uri& uri);

/// The schemes that this program supports; see transport.h.
std::vector<std::string_view> transports();

/// Waits for the next message and takes it; false at the end.
///
/// Errors: those of Source::take(), and Stopped when `stop` becomes readable.
Result<bool> receive(Source& source, Message& message, int stop = -1);

/// Whether the elements are in a publisher's shared memory. A reader that holds 63 such messages
/// gets copies of further ones, and a publisher without free memory waits for them to be released.
bool is_lent(const Message& message);

}  // namespace hc
