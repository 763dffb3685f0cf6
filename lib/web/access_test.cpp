// SPDX-License-Identifier: Apache-2.0
#include <web/access.h>

#include <gtest/gtest.h>

namespace hc::web {

namespace {

Access local() {
  return Access({.address = "127.0.0.1", .port = 8470, .is_secure = false, .hosts = {}});
}

std::string token_of(const std::string& url) {
  return url.substr(url.find("token=") + 6);
}

TEST(Access, loopback_has_loopbacks_names_alone) {
  const auto access = local();
  for (const char* host : {"localhost:8470", "127.0.0.1:8470", "[::1]:8470", "localhost"})
    EXPECT_TRUE(access.is_host(host)) << host;
  for (const char* host : {"", "evil.example:8470", "192.168.1.7:8470", "localhost:80",
                           "127.0.0.1.evil.example", "localhost.evil:8470", "127.0.0.1:8470:1"})
    EXPECT_FALSE(access.is_host(host)) << host;
}

TEST(Access, elsewhere_any_address_and_the_given_names) {
  const Access access({"0.0.0.0", 443, true, {"head.local"}});
  for (const char* host : {"192.168.1.7:443", "[fe80::1]:443", "head.local", "head.local:443"})
    EXPECT_TRUE(access.is_host(host)) << host;
  for (const char* host : {"evil.example", "evil.example:443", "192.168.1.7:80", "192.168.1"})
    EXPECT_FALSE(access.is_host(host)) << host;
}

TEST(Access, who_listens_everywhere_invites_by_an_address_or_a_name) {
  const Place everywhere{"0.0.0.0", 443, true, {}};
  EXPECT_TRUE(Access(everywhere).invite(Right::View).starts_with("https://" + own_address() + ":"));
  EXPECT_NE(own_address(), "0.0.0.0");
  Place named = everywhere;
  named.hosts = {"head.local"};
  EXPECT_TRUE(Access(named).invite(Right::View).starts_with("https://head.local:443/"));
}

TEST(Access, an_origin_is_exactly_that_of_the_page) {
  const auto access = local();
  EXPECT_TRUE(access.is_origin("http://localhost:8470", "localhost:8470"));
  for (const char* origin : {"", "null", "https://localhost:8470", "http://localhost:8471",
                             "http://localhost:8470/", "http://127.0.0.1:8470"})
    EXPECT_FALSE(access.is_origin(origin, "localhost:8470")) << origin;
  const Access secure({"0.0.0.0", 443, true, {}});
  EXPECT_TRUE(secure.is_origin("https://10.0.0.1:443", "10.0.0.1:443"));
}

TEST(Access, a_token_counts_once_and_gives_its_right) {
  auto access = local();
  const std::string url = access.invite(Right::View);
  EXPECT_TRUE(url.starts_with("http://127.0.0.1:8470/?token=")) << url;
  const auto session = access.redeem(token_of(url));
  ASSERT_TRUE(session);
  EXPECT_FALSE(access.redeem(token_of(url)));
  EXPECT_FALSE(access.redeem(""));
  EXPECT_FALSE(access.redeem(*session));
  const std::string cookie = access.cookie_name() + "=" + *session;
  EXPECT_EQ(access.right_of(cookie), Right::View);
  EXPECT_EQ(access.right_of("a=b; " + cookie + "; c"), Right::View);
  for (const auto& wrong : {std::string(), cookie + "0", "x" + cookie, access.cookie_name() + "="})
    EXPECT_FALSE(access.right_of(wrong)) << wrong;
  for (const auto right : {Right::Drive, Right::Operate}) {
    const auto other = access.redeem(access.make_token(right));
    EXPECT_EQ(access.right_of(access.cookie_name() + "=" + *other), right);
  }
}

TEST(Access, rights_have_names_and_include_those_before) {
  for (const auto right : {Right::View, Right::Drive, Right::Operate})
    EXPECT_EQ(right_named(name_of(right)), right);
  for (const char* wrong : {"", "View", "admin", "operate "}) EXPECT_FALSE(right_named(wrong));
  EXPECT_LT(Right::View, Right::Drive);
  EXPECT_LT(Right::Drive, Right::Operate);
}

TEST(Access, a_socket_is_opened_by_the_name_of_a_session) {
  auto access = local();
  const std::string url = access.invite_socket(Right::Drive);
  EXPECT_TRUE(url.starts_with("ws://127.0.0.1:8470/?token=")) << url;
  EXPECT_EQ(access.right_of_session(token_of(url)), Right::Drive);
  EXPECT_EQ(access.right_of_session(token_of(url)), Right::Drive) << "again";
  EXPECT_FALSE(access.right_of_session(token_of(access.invite(Right::Drive))));
  Access secure({"::1", 443, true, {}});
  EXPECT_TRUE(secure.invite_socket(Right::View).starts_with("wss://[::1]:443/?token="));
}

TEST(Access, a_session_is_known_to_a_process_of_the_same_run_alone) {
  const Place place{.address = "127.0.0.1", .port = 8470, .is_secure = false, .hosts = {}};
  Access before(place, "key");
  const auto name = *before.redeem(before.make_token(Right::View));
  EXPECT_EQ(Access(place, "key").right_of_session(name), Right::View);
  EXPECT_FALSE(Access(place, "other").right_of_session(name));
  auto elsewhere = place;
  elsewhere.port = 8765;
  EXPECT_FALSE(Access(elsewhere, "key").right_of_session(name)) << "another server of the run";
  EXPECT_NE(*before.redeem(before.make_token(Right::View)), name);
  const auto end = name.substr(name.find('.'));
  for (const auto& forged : {"operate" + end, "drive" + end, name + "0", "." + name, name.substr(1),
                             name.substr(0, name.rfind('.') + 1), std::string("view.."), end})
    EXPECT_FALSE(before.right_of_session(forged)) << forged;
}

TEST(Access, secrets_differ_and_the_oldest_tokens_are_forgotten) {
  auto access = local();
  const auto first = access.make_token(Right::View), second = access.make_token(Right::View);
  EXPECT_EQ(first.size(), 32U);
  EXPECT_NE(first, second);
  for (int i = 0; i < 63; ++i) access.make_token(Right::View);
  EXPECT_FALSE(access.redeem(first));
  EXPECT_TRUE(access.redeem(second));
}

}  // namespace

}  // namespace hc::web
