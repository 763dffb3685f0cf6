// SPDX-License-Identifier: Apache-2.0
#pragma once
// Links carry messages one way: a Sink puts them in, a Source takes them out. A URI says what
// carries them; table.cpp lists their schemes, and each transport is a file of its own.
// An object is used from one thread; different objects from different threads.

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

/// What came of asking a source.
enum class Got {
  Message,  ///< a message
  Nothing,  ///< none now; WaitSet waits for the next
  End,      ///< none any more: the other side has closed, or the file is at its end
};

/// The end of a link where messages come out.
class Source {
 public:
  Source();
  virtual ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Takes the next message; never waits. `message` keeps its elements alive on its own; what it
  /// held before is let go of, whatever comes.
  ///
  /// Errors: those of StreamReader, Truncated, Closed (the peer has died or vanished), NotFound (it
  /// never was there), System; the link is of no use afterwards. A
  /// listening source closes the connection at fault, logs it, and continues with the others.
  virtual Result<Got> take(Message& message) = 0;

  // How to wait. WaitSet does it for any number of sources; an event loop may do the same.

  /// A descriptor for poll(): readable when take() has something to do, if prepare_wait() was true
  /// since take() gave Nothing. The same for life.
  [[nodiscard]] virtual int descriptor() const = 0;

  /// A second descriptor, to be watched edge-triggered (EPOLLET) and never read: it announces
  /// messages that come in memory. The same for life; -1: descriptor() announces them all.
  [[nodiscard]] virtual int wake_descriptor() const { return -1; }

  /// Asks for the next message to be announced; false when there is something to take already.
  virtual bool prepare_wait() { return true; }

  /// What to look at before sleeping, until the next take().
  struct Spin {
    const std::atomic<std::uint64_t>* word = nullptr;  ///< null: there is nothing to see
    std::uint64_t value = 0;            ///< a message is there when the word is at least that
    std::chrono::microseconds time{0};  ///< how long
  };
  [[nodiscard]] virtual Spin spin() const { return {}; }

  /// Waits for this source alone, as WaitSet does; false when `timeout` has passed.
  ///
  /// Errors: Stopped (`stop` is readable), System.
  Result<bool> wait(int stop = -1,
                    std::chrono::milliseconds timeout = std::chrono::milliseconds(-1));

  /// What take() has given so far.
  [[nodiscard]] virtual Traffic traffic() const = 0;

  /// Peers that are connected now; nothing where none connects, as with a file, or that is unknown.
  [[nodiscard]] virtual std::optional<std::size_t> peers() const { return std::nullopt; }

  /// Says that the peer will not come back: the end of the connection there is, or that there is
  /// none, is the end of the link. Only a source that reconnects needs this.
  virtual void finish() {}

  /// Continues after an error that take() gave, at the next valid header (R40).
  ///
  /// Errors: Unsupported for everything that cannot be read once more; files can.
  virtual Status resume() {
    return Error{Code::Unsupported, "only a file can be read on after an error"};
  }

 private:
  friend class WaitSet;
  const std::uint64_t number_;      // no other source of this process has or had it
  std::unique_ptr<WaitSet> alone_;  // for wait()
};

/// The end of a link where messages go in.
class Sink {
 public:
  virtual ~Sink() = default;

  /// Puts a message in, whole. Waits as long as the link is full or has no reader yet; with another
  /// `keep` than all it does not wait for a reader that is slow.
  ///
  /// Errors: Closed (the reader disconnected, or abandon() was called meanwhile), NotFound (no
  /// reader was found), Stopped (LinkOptions::stop became readable before the first byte went),
  /// Truncated (it became so later, and the reader did not take the rest within 2 s; the link is of
  /// no use afterwards), System.
  virtual Status send(const Message& message) = 0;

  /// A message to be filled in place and sent: in the memory that readers will see where the
  /// transport shares any, else on the heap. Sent to another sink, it is copied there.
  /// A header that check() refuses is a bug.
  virtual Draft loan(const Header& header) { return Draft::make(header); }

  /// Ends the link: the reader finds End behind the last message. Errors as send().
  virtual Status close() = 0;

  /// Ends the link and waits for nobody: what is still on its way to a reader is lost, and counted
  /// (Traffic::dropped_disconnect), unless the reader has the memory where it is. Nothing is sent
  /// any more.
  virtual void abandon() {}

  /// What send() has taken so far; a message to several readers counts once.
  [[nodiscard]] virtual Traffic traffic() const = 0;

  /// As Source::peers(); lets in readers that wait to connect. Not to be called within send().
  virtual std::optional<std::size_t> peers() { return std::nullopt; }
};

/// How a link behaves, whatever carries it.
struct LinkOptions {
  Limits limits;  ///< of what is read
  /// Gets a line when a connection was made or failed, with the URI before it, on the threads that
  /// use the link's end; may be empty.
  LogSink log;
  int stop = -1;  ///< descriptor that is readable when waiting is to end; -1: none
  /// What a sink that waits for a reader, or for room, does besides.
  struct Interrupt {
    int descriptor = -1;  ///< when it is readable, `call` is made; -1: never
    /// On the thread that sends; it may abandon() the sink. False: not to be called any more.
    std::function<bool()> call;
  } interrupt = {};
  /// Called when a sink waits for a reader to come, or for long for one to take something, and when
  /// it has waited, on the thread that sends; may be empty.
  std::function<void(bool awaits)> awaits_reader = {};
};

/// Opens the end of a link where messages come out, or go in.
///
/// What URIs there are, and what options each end has: doc/modules.md, "Links".
///
/// Errors: Invalid (no such scheme; an option that it does not have, or not with that value),
/// NotFound (no such file or host), Closed (nobody listens), Stopped, System (name in use, …).
Result<std::unique_ptr<Source>> open_source(const Uri& uri, const LinkOptions& options = {});
Result<std::unique_ptr<Sink>> open_sink(const Uri& uri, const LinkOptions& options = {});

/// Whether a URI makes sense at a source or a sink, as far as is known while nothing is opened.
///
/// Errors: Invalid.
Status check_source(const Uri& uri);
Status check_sink(const Uri& uri);

/// The schemes that open_source() and open_sink() know in this program; see transport.h.
std::vector<std::string_view> transports();

/// Takes the next message, waiting for it; false at the end.
///
/// Errors: as Source::take, and Stopped when `stop` becomes readable.
Result<bool> receive(Source& source, Message& message, int stop = -1);

/// Whether a publisher of shm lends the elements of a message: a reader that holds 63 gets further
/// ones as copies, and a publisher without room waits for those.
bool is_lent(const Message& message);

}  // namespace hc
