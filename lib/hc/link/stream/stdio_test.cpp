// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>

#include <hc/mtp/codec.h>
#include <hc/os/descriptor.h>
#include <hc/testing/link_conformance.h>

namespace hc::testing {
namespace {

/// Puts a pipe in the place of standard input and output, as a shell does, until the test ends.
class Stdio : public ::testing::Test {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    for (int i : {0, 1}) {
      saved_[i] = Descriptor(::fcntl(i, F_DUPFD_CLOEXEC, 3));
      ::dup2(ends[i], i);
      ::close(ends[i]);
    }
  }
  void TearDown() override {
    for (int i : {0, 1}) ::dup2(saved_[i].get(), i);
  }
  /// Lets go of our copy of an end, so that the other one notices.
  void release(int i) const { ::dup2(saved_[i].get(), i); }

  Descriptor saved_[2];
};

TEST_F(Stdio, CarriesMessages) {
  auto source = source_of("-");
  auto sink = sink_of("-");
  release(1);
  std::thread sender([&] {
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(sink->send(numbered(i, 100'000)));
    ASSERT_TRUE(sink->close());
  });
  Message message;
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(next(*source).text(), numbered(i, 100'000).text());
  }
  EXPECT_FALSE(*receive(*source, message));
  sender.join();
}

TEST_F(Stdio, TheFlagsOfTheShellsDescriptorsStay) {
  auto source = source_of("-");
  auto sink = sink_of("-");
  EXPECT_EQ(::fcntl(0, F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(::fcntl(1, F_GETFL) & O_NONBLOCK, 0);
  Message message;
  EXPECT_EQ(*source->take(message), Got::Nothing);
}

TEST_F(Stdio, TheFlagsOfTheShellsSocketsStay) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  for (int i : {0, 1}) {
    ::dup2(ends[i], i);
    ::close(ends[i]);
  }
  auto source = source_of("-");
  Stop stop;
  stop.raise();
  auto sink = sink_of("-", stop.options());
  Message message;
  EXPECT_EQ(*source->take(message), Got::Nothing);
  ASSERT_TRUE(sink->send(numbered(0, 10)));
  EXPECT_TRUE(*receive(*source, message));
  Status sent;  // a message this small goes whole or not at all
  for (int i = 0; sent; ++i) sent = sink->send(numbered(i, 1000));
  EXPECT_EQ(sent.error().code, Code::Stopped);
  EXPECT_EQ(::fcntl(0, F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(::fcntl(1, F_GETFL) & O_NONBLOCK, 0);
}

TEST_F(Stdio, AReaderThatHasGoneIsAnEnd) {
  auto sink = sink_of("-");
  release(0);
  EXPECT_EQ(sink->send(numbered(0, 10)).error().code, Code::Closed);
}

TEST_F(Stdio, WaitingEndsWhenAskedToStop) {
  Stop stop;
  stop.raise();
  auto sink = sink_of("-", stop.options());
  // Full already, since messages that are written together may go in part.
  const Descriptor pipe(::open("/proc/self/fd/1", O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  const std::string rubbish(1 << 20, ' ');
  while (::write(pipe.get(), rubbish.data(), rubbish.size()) > 0) {
  }
  Status sent;
  for (int i = 0; sent; ++i) sent = sink->send(numbered(i, 1000));
  release(1);  // where a failure is printed
  EXPECT_EQ(sent.error().code, Code::Stopped);
}

TEST_F(Stdio, AMessageThatWasBegunIsFinishedBeforeItStops) {
  Stop stop;
  stop.raise();
  auto sink = sink_of("-", stop.options());
  auto source = source_of("-");
  std::thread reader([&] { EXPECT_EQ(next(*source).text(), numbered(0, 4'000'000).text()); });
  EXPECT_TRUE(sink->send(numbered(0, 4'000'000)));
  reader.join();
}

TEST_F(Stdio, AMessageThatCannotBeFinishedIsReported) {
  Stop stop;
  stop.raise();
  auto sink = sink_of("-", stop.options());
  const auto sent = sink->send(numbered(0, 4'000'000));
  release(1);
  EXPECT_EQ(sent.error().code, Code::Truncated);
}

TEST_F(Stdio, R40_IsReadOnBehindDamageInAFileThatWasBegun) {
  std::string bytes = encode(numbered(0, 300));
  std::string rest = "1 7 0 0 8 0 40101 0 7 50000 1\nshort\n" + encode(numbered(1, 3));
  std::FILE* file = std::tmpfile();
  std::fwrite((bytes + rest).data(), 1, (bytes + rest).size(), file);
  std::fflush(file);
  ::lseek(::fileno(file), static_cast<off_t>(bytes.size()), SEEK_SET);
  ::dup2(::fileno(file), 0);
  std::fclose(file);
  auto source = source_of("-");
  Message message;
  EXPECT_FALSE(receive(*source, message));
  ASSERT_TRUE(source->resume());
  EXPECT_EQ(next(*source).header.seq, 1);
}

TEST_F(Stdio, CannotBeReadOnAfterAnError) {
  auto source = source_of("-");
  ASSERT_EQ(::write(1, "rubbish\n", 8), 8);
  Message message;
  EXPECT_FALSE(receive(*source, message));
  EXPECT_EQ(source->resume().error().code, Code::Unsupported);
}

}  // namespace
}  // namespace hc::testing
