// SPDX-License-Identifier: Apache-2.0
#include <sys/un.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <hc/testing/socket_link.h>

namespace hc::testing {
namespace {

namespace fs = std::filesystem;

int number = 0;

std::string abstract_name() {
  return "@hc-test-" + std::to_string(::getpid()) + "-" + std::to_string(number++);
}

std::string path() {
  return (fs::temp_directory_path() / abstract_name().substr(1)).string();
}

Descriptor connect_by_name(const std::string& place) {
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, place.data(), place.size());
  bool is_abstract = address.sun_path[0] == '@';
  if (is_abstract) address.sun_path[0] = '\0';
  auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + place.size() +
                                     (is_abstract ? 0 : 1));
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  return socket;
}

const SocketScheme kAbstract{
    "abstract",          abstract_name,        "unix:", "unix-listen:", connect_by_name,
    internal::unix_peer, internal::listen_unix};
const SocketScheme kPath{"path",
                         path,
                         "unix:",
                         "unix-listen:",
                         connect_by_name,
                         internal::unix_peer,
                         internal::listen_unix};

INSTANTIATE_TEST_SUITE_P(Abstract, LinkConformance, ::testing::ValuesIn(both_ways(kAbstract)));
INSTANTIATE_TEST_SUITE_P(Path, LinkConformance, ::testing::ValuesIn(both_ways(kPath)));
INSTANTIATE_TEST_SUITE_P(Unix, SocketLink, ::testing::Values(kAbstract, kPath));
INSTANTIATE_TEST_SUITE_P(Unix, AcceptingLink, ::testing::Values(kAbstract, kPath));

TEST(Unix, LeavesNoFile) {
  std::string file = path();
  source_of("unix-listen:" + file).reset();
  EXPECT_FALSE(fs::exists(file));
}

TEST(Unix, TakesTheFileOverThatADeadProcessLeft) {
  std::string file = path();
  {
    Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, file.data(), file.size());
    ASSERT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ASSERT_TRUE(fs::exists(file));
  auto source = source_of("unix-listen:" + file);
  EXPECT_TRUE(open_sink(*parse_uri("unix:" + file)));
}

TEST(Unix, OtherFilesAreNotTouched) {
  std::string file = path();
  { std::ofstream(file) << "mine"; }
  EXPECT_FALSE(open_source(*parse_uri("unix-listen:" + file)));
  EXPECT_TRUE(fs::exists(file));
  fs::remove(file);
}

TEST(Unix, NamesHaveALength) {
  EXPECT_EQ(open_source(*parse_uri("unix:" + std::string(200, 'x'))).error().code, Code::Invalid);
  EXPECT_EQ(open_source(*parse_uri("unix:")).error().code, Code::Invalid);
}

}  // namespace
}  // namespace hc::testing
