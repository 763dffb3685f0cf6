// SPDX-License-Identifier: Apache-2.0
#include <graph/plan.h>

#include <gtest/gtest.h>

#include <netinet/in.h>

#include <graph/held_port.h>
#include <graph/plan/planning_test.h>
#include <hc/os/socket.h>

namespace hc {
namespace {

TEST(Plan, GivesEveryLinkTwoEnds) {
  auto planned = must(plan(R"([modules.source]
parameters.rate = 3
addresses = { left = 11 }
encodings = { left = "zstd" }
[modules.a]
program = "filter"
[modules.sink]
[[modules.a.inputs.in]]
from = "source.left"
[[modules.sink.inputs.in]]
from = "source.right"
[[modules.sink.inputs.in]]
from = "a.out"
)"));
  EXPECT_EQ(text_of(planned.modules[0].command()),
            "source --name source --encoding left=zstd --address left=11 --address right=1 "
            "--rate=3 --manage unix:@t.source.manage?wait=10 "
            "--out left=unix-listen:@t.source.left.a.in?readers=1&stay=1 "
            "--out right=unix-listen:@t.source.right.sink.in?readers=1&stay=1");
  EXPECT_EQ(text_of(planned.modules[1].command()),
            "filter --name a --address out=2 --manage unix:@t.a.manage?wait=10 "
            "--in in=unix:@t.source.left.a.in?wait=60 "
            "--out out=unix-listen:@t.a.out.sink.in?readers=1&stay=1");
  EXPECT_EQ(planned.modules[1].manage_uri, "unix-listen:@t.a.manage");
  const PlannedLink& link = planned.links[2];
  EXPECT_EQ(link.from, "a.out");
  EXPECT_EQ(link.to, "sink.in");
  EXPECT_EQ(link.sender_uri, planned.modules[1].ends[1].uri);
  EXPECT_EQ(link.reader_uri, planned.modules[2].ends[1].uri);
}

TEST(Plan, NamesOfLinksThatAreTooLongBecomeShort) {
  const std::string a = "a" + std::string(62, 'b');
  auto planned = must(plan("[modules." + a + "]\nprogram = \"source\"\n[modules." + a +
                           "c]\nprogram = \"sink\"\ninputs.in = \"" + a + ".right\"\n"));
  const std::string& uri = planned.links[0].sender_uri;
  EXPECT_TRUE(uri.starts_with("unix-listen:@t.")) << uri;
  EXPECT_EQ(uri.size(), std::string("unix-listen:@t.0123456789abcdef?readers=1&stay=1").size())
      << uri;
  EXPECT_TRUE(planned.links[0].reader_uri.starts_with("unix:@" + uri.substr(13, 18)));
}

TEST(Plan, LinksOfAnOutputShareItsMemory) {
  auto link = [](const std::string& to, const std::string& more = "") {
    return link_text("eye.image", to, more + "\n");
  };
  auto planned = must(plan(R"([modules.eye]
[modules.a]
program = "seer"
[modules.b]
program = "seer"
[modules.any]
)" + link("a.in") + link("b.in", "keep = \"all\"") +
                           link("a.more", "keep = 3\nrate = 10\nmemory = \"8M\"") +
                           link("any.in")));
  using Strings = std::vector<std::string>;
  EXPECT_EQ(values_of(planned.modules[0], "--out"),
            (Strings{"image=shm:t.eye.image?readers=2&stay=1",
                     "image=shm:t.eye.image.a.more?readers=1&stay=1&keep=3&memory=8M",
                     "image=unix-listen:@t.eye.image.any.in?readers=1&stay=1&keep=latest"}));
  EXPECT_EQ(values_of(planned.modules[1], "--in"),
            (Strings{"in=shm:t.eye.image?wait=60&keep=latest",
                     "more=shm:t.eye.image.a.more?wait=60&keep=3&rate=10"}));
  EXPECT_EQ(values_of(planned.modules[2], "--in"), (Strings{"in=shm:t.eye.image?wait=60"}));
  EXPECT_EQ(values_of(planned.modules[3], "--in"),
            (Strings{"in=unix:@t.eye.image.any.in?wait=60"}));
  EXPECT_EQ(planned.links[0].sender_uri, planned.links[2].sender_uri);
  EXPECT_EQ(planned.links[1].keep, "3");
  EXPECT_EQ(planned.links[1].policy,
            (std::map<std::string, std::string>{{"memory", "8M"}, {"rate", "10"}}));
}

TEST(Plan, LinksThatAreTakenTogetherAreAdaptedAlike) {
  auto planned = must(plan("[modules.task]\n[modules.pair]\n" +
                           link_text("task.command", "pair.left", "bandwidth = 5000\n") +
                           link_text("task.bid", "pair.right", "bandwidth = \"5 kB/s\"\n")));
  for (const auto& link : planned.links)
    EXPECT_TRUE(link.sender_uri.ends_with("&pair=pair.left")) << link.sender_uri;
}

TEST(Plan, AnInputSaysHowManyMessagesItsLinksKeep) {
  auto planned =
      must(plan("[modules.source]\n[modules.keeper]\n" + link_text("source.left", "keeper.in") +
                link_text("source.left", "keeper.some") +
                link_text("source.right", "keeper.in", "keep = \"all\"\n") +
                link_text("source.right", "keeper.some", "keep = 3\n")));
  std::vector<std::string> keeps;
  for (const auto& link : planned.links) keeps.push_back(link.keep);
  EXPECT_EQ(keeps, (std::vector<std::string>{"latest", "all", "16", "3"}));
  EXPECT_TRUE(planned.links[2].sender_uri.ends_with("&keep=16")) << planned.links[2].sender_uri;
}

TEST(Plan, ALinkGoesOverTcpWhereBothEndsHaveNothingBetter) {
  const std::string text = "[modules.source]\n[modules.java]\ninputs.in = \"source.left\"\n" +
                           link_text("java.out", "filter.in") + "[modules.filter]\n";
  auto hold = [](const std::string&, bool of_all) { return hc::hold_port(of_all); };
  auto looked_at = must(plan(text));
  EXPECT_EQ(looked_at.links[0].reader_uri, "tcp:127.0.0.1:0?wait=60&same_user=1");
  auto planned = must(plan(text, {}, nullptr, hold));
  const auto& ports = planned.ports;
  ASSERT_EQ(ports.size(), 2U);
  const auto number = ports.at("t.source.left.java.in")->number;
  const std::string port = std::to_string(number);
  EXPECT_EQ(planned.links[0].sender_uri,
            "tcp-listen:127.0.0.1:" + port + "?readers=1&stay=1&same_user=1");
  EXPECT_EQ(planned.links[0].reader_uri, "tcp:127.0.0.1:" + port + "?wait=60&same_user=1");
  EXPECT_NE(ports.at("t.java.out.filter.in")->number, number);
  // The module can listen on the port, which stays the link's in the next plan.
  sockaddr_in place{AF_INET, htons(number), {htonl(INADDR_LOOPBACK)}, {}};
  EXPECT_TRUE(listen_on({&place, sizeof place}, port));
  auto next = must(plan(text + "parameters.rate = 1\n", {}, &planned, hold));
  EXPECT_EQ(next.ports, planned.ports);
  EXPECT_EQ(next.links[1].sender_uri, planned.links[1].sender_uri);
}

TEST(Plan, TheEndsOfALinkHaveATransportInCommon) {
  EXPECT_EQ(wrong("[modules.java]\n[modules.files]\ninputs.in = \"java.out\"\n"),
            "g.toml:4: no transport from java.out to files.in: module java supports tcp, "
            "tcp-listen, module files supports file, tcp-listen; it takes shm at both ends, or "
            "tcp-listen at java and tcp at files, or unix-listen and unix");
  EXPECT_EQ(wrong("[modules.liar]\n"),
            "g.toml:2: module liar supports --control, which takes unix: URIs, but its program "
            "does not list unix in \"transports\"");
}

TEST(Plan, MemoryThatIsSharedIsEnough) {
  auto with_reader = [](const std::string& reader) {
    return wrong("[modules.eye]\n[modules." + reader + "]\n" +
                 link_text("eye.image", reader + ".in", "memory = \"1M\"\n"));
  };
  EXPECT_EQ(with_reader("seer"),
            "g.toml:6: memory is at least 1576960 bytes where it is shared, not 1048576");
  EXPECT_EQ(with_reader("any"), "");  // over a socket
}

TEST(Plan, ErrorsNameTheLineAndWhatWouldBeRight) {
  auto link = [](const std::string& from, const std::string& to) {
    return "[modules.source]\n[modules.sink]\n[modules.filter]\n" + link_text(from, to);
  };
  const std::pair<std::string, std::string> cases[] = {
      {"[modules.x]\n", "g.toml:2: module x: no such program"},
      {"[modules.dumb]\n",
       "g.toml:2: module dumb: dumb --describe does not print the description of a module; "
       "see spec/module.md"},
      {"[modules.odd]\nparameters.rate=1",
       "g.toml:2: module odd: odd --describe does not print the description of a module; "
       "see spec/module.md"},
      {"[modules.loud]\n", "g.toml:2: module loud: output name \"Out\" is not snake_case"},
      {"[modules.source]\nparameters.rat = 3",
       "g.toml:3: module source has no parameter \"rat\", did you mean \"rate\"?"},
      {"[modules.source]\naddresses.lft = 3",
       "g.toml:3: module source has no port \"lft\", did you mean \"left\"?"},
      {"[modules.source]\nencodings.x = \"text\"", "g.toml:3: module source has no output \"x\""},
      {"[modules.source]\n\nencodings.left = \"jpeg\"",
       "g.toml:4: module source: R21 left: jpeg is for images of 1 or 3 components of u8, not map "
       "of 1 x f32"},
      {"[modules.source]\naddresses = { left = 3, right = 3 }",
       "g.toml:3: address 3 is used twice"},
      {"[modules.source]\nparameters.rate = 10",
       "g.toml:3: module source: parameter rate: \"10\" is not from 0 to 9"},
      {"[modules.source]\n\nparameters.mode = \"slow\"",
       "g.toml:4: module source: parameter mode: \"slow\" is not one of fast, good"},
      {link("sorce.left", "filter.in"), "g.toml:5: no module \"sorce\", did you mean \"source\"?"},
      {link("source.up", "filter.in"), "g.toml:5: module source has no output \"up\""},
      {link("source.left", "filter.into"), "g.toml:5: module filter has no input \"into\""},
      {link("source.left", "sink.in"),
       "g.toml:5: source.left sends map of 1 x f32 in coordinate system left_image (7), sink.in "
       "takes "
       "map of 1 x f32 in coordinate system right_image (8)"},
      {link("source.left", "sink.text"), "g.toml:5: source.left sends map"},
      {link("source.left", "filter.in") + "[[modules.filter.inputs.in]]\nfrom = \"source.left\"\n",
       "g.toml:7: duplicate link from source.left to filter.in"},
  };
  for (const auto& [text, wanted] : cases) {
    EXPECT_TRUE(wrong(text).starts_with(wanted)) << wrong(text);
  }
}

TEST(Plan, TwoLinksCannotListenAtThePortOfOneHost) {
  auto listening = [](const std::string& first, const std::string& second) {
    return wrong("[modules.source]\noutputs.left = \"" + first + "\"\noutputs.right = \"" + second +
                 "\"\n");
  };
  EXPECT_EQ(listening("tcp-listen:7000", "tcp-listen:127.0.0.1:7000"),
            "g.toml:4: another link also listens at tcp-listen:127.0.0.1:7000");
  EXPECT_EQ(listening("tcp-listen:0.0.0.0:7000", "tcp-listen:7000"),
            "g.toml:4: another link also listens at tcp-listen:7000");
  EXPECT_EQ(listening("tcp-listen:192.0.2.1:7000", "tcp-listen:7000"), "");
}

TEST(Plan, TwoLinksCannotWriteToOneSharedMemory) {
  const auto problems =
      wrong("[modules.source]\noutputs.left = \"shm:s\"\noutputs.right = \"shm:s?keep=1\"\n");
  EXPECT_NE(problems.find("g.toml:4: another link also writes to shm:s?keep=1"), problems.npos)
      << problems;
}

TEST(Plan, OutputsWithoutALinkAreKnown) {
  auto planned = must(plan("[modules.source]\n[modules.any]\ninputs.in = \"source.left\"\n"));
  EXPECT_EQ(planned.unlinked, std::vector<std::string>{"source.right"});
}

TEST(Plan, InputsThatAreTakenTogetherAreAllLinked) {
  EXPECT_EQ(wrong("[modules.source]\n[modules.pair]\ninputs.left = \"source.left\"\n"),
            "g.toml:3: module pair takes left together with right, which has no link");
  EXPECT_EQ(wrong("[modules.pair]\n"), "");
}

TEST(Plan, AllErrorsAreReportedAtOnceInTheOrderOfTheLines) {
  EXPECT_EQ(
      wrong(R"([modules.source]
parameters = { rat = 3, rate = 10 }
addresses.lft = 1
[modules.x]
[modules.sink]
inputs.inn = "x.out"
inputs.in = "source.left"
[[modules.snk.inputs.in]]
from = "source.left"
)"),
      R"(g.toml:3: module source has no parameter "rat", did you mean "rate"?
g.toml:3: module source: parameter rate: "10" is not from 0 to 9
g.toml:4: module source has no port "lft", did you mean "left"?
g.toml:5: module x: no such program
g.toml:7: module sink has no input "inn", did you mean "in"?
g.toml:8: source.left sends map of 1 x f32 in coordinate system left_image (7), sink.in takes )"
      "map of 1 x f32 in coordinate system right_image (8)\ng.toml:9: module snk: no such program");
}

TEST(Plan, ALoopHasARate) {
  auto loop = [](const std::string& more) {
    return wrong(
        "[modules.source]\n[modules.a]\nprogram = \"filter\"\n[modules.b]\n"
        "program = \"filter\"\n"
        "[[modules.a.inputs.in]]\nfrom = \"source.left\"\n"
        "[[modules.b.inputs.in]]\nfrom = \"a.out\"\n"
        "[[modules.a.inputs.in]]\nfrom = \"b.out\"\n" +
        more);
  };
  EXPECT_EQ(loop(""),
            "g.toml:11: loop without a rate: a -> b -> a; give one of its links a rate, for "
            "example rate = 30");
  EXPECT_EQ(loop("rate = 30\n"), "");
  EXPECT_EQ(wrong("[modules.filter]\ninputs.on = \"filter.out\"\n"),
            "g.toml:3: module filter has no input \"on\", did you mean \"in\"?");  // and no loop
  EXPECT_TRUE(wrong("[modules.filter]\ninputs.in = \"filter.out\"\n")
                  .starts_with("g.toml:3: loop without a rate: filter -> filter;"));
}

}  // namespace
}  // namespace hc
