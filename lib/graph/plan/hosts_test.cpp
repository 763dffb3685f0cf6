// SPDX-License-Identifier: Apache-2.0
// Modules on other hosts, and the links between them.
#include <graph/plan/planning_test.h>

#include <gtest/gtest.h>

#include <graph/held_port.h>

namespace hc {
namespace {

const std::string kHosts =
    "[hosts.robot]\nssh = \"pi@robot\"\n"
    "[hosts.lab]\nssh = [\"-p\", \"2222\", \"lab\"]\nhc = \"/opt/bin/hc\"\naddress = \"lab.lan\"\n";
const HostPlaces kPlaces = {{"", {"", "", "F0"}},
                            {"robot", {"10.0.0.2", "10.0.0.1", "F1"}},
                            {"lab", {"fe80::3", "fe80::1", "F2"}}};

/// A module with the program `far`, whose input reads an output.
std::string far(const std::string& name, const std::string& host, const std::string& from = "",
                const std::string& more = "") {
  return "[modules." + name + "]\nprogram = \"far\"\n" +
         (host.empty() ? "" : "host = \"" + host + "\"\n") +
         (from.empty() ? "" : "inputs.in = { from = \"" + from + ".out\"" + more + " }\n");
}

/// plan() with TCP ports from 7001.
Result<Plan> plan_hosts(const std::string& text, const HostPlaces& places = kPlaces) {
  auto number = std::make_shared<std::uint16_t>(7000);
  auto hold = [number](const std::string&, bool) {
    return Result<std::shared_ptr<const HeldPort>>(
        std::make_shared<const HeldPort>(HeldPort{Descriptor(), ++*number}));
  };
  return plan(kHosts + text, {}, nullptr, hold, places);
}

TEST(HostsOfAGraph, AreDeclaredAndHaveModules) {
  auto planned = must(plan_hosts(far("a", "robot") + far("b", "lab", "a") + far("c", "", "a")));
  EXPECT_EQ(planned.modules[0].host, "robot");
  EXPECT_EQ(planned.modules[1].host, "lab");
  EXPECT_EQ(planned.modules[2].host, "");
}

TEST(HostsOfAGraph, HaveLinksOverTlsBetweenThem) {
  auto planned = must(plan_hosts(far("a", "robot") + far("b", "lab", "a") + far("c", "robot", "a") +
                                 far("d", "", "a") + far("e", "robot", "d")));
  const auto& links = planned.links;
  EXPECT_EQ(links[0].sender_uri,
            "tls-listen:0.0.0.0:7001?readers=1&stay=1&key=/proc/self/fd/3&peer=F2");
  EXPECT_EQ(links[0].reader_uri, "tls:10.0.0.2:7001?wait=60&key=/proc/self/fd/3&peer=F1");
  EXPECT_TRUE(links[1].reader_uri.starts_with("shm:")) << links[1].reader_uri;
  EXPECT_EQ(links[2].reader_uri, "tls:10.0.0.2:7002?wait=60&key=/proc/self/fd/3&peer=F1");
  // The host of hc run has an address for each other host.
  EXPECT_EQ(links[3].sender_uri,
            "tls-listen:0.0.0.0:7003?readers=1&stay=1&key=/proc/self/fd/3&peer=F1");
  EXPECT_EQ(links[3].reader_uri, "tls:10.0.0.1:7003?wait=60&key=/proc/self/fd/3&peer=F0");
}

TEST(HostsOfAGraph, MayHaveAddressesOfVersion6) {
  auto planned = must(plan_hosts(far("a", "lab") + far("b", "", "a")));
  EXPECT_TRUE(planned.links[0].sender_uri.starts_with("tls-listen:[::]:7001?"));
  EXPECT_TRUE(planned.links[0].reader_uri.starts_with("tls:[fe80::3]:7001?"));
}

TEST(HostsOfAGraph, WithoutAnAddressHaveNoLinks) {
  const HostPlaces nowhere = {{"", {"", "", "F0"}}, {"robot", {"", "", "F1"}}};
  EXPECT_EQ(plan_hosts(far("a", "robot") + far("b", "", "a"), nowhere).error().detail,
            "g.toml:13: host robot has no address that links can use: set address = \"…\" in its "
            "table");
  EXPECT_EQ(plan_hosts(far("a", "") + far("b", "robot", "a"), nowhere).error().detail,
            "g.toml:13: host robot has no address of this host that links can use: connect to it "
            "by an address that is not link-local");
}

TEST(HostsOfAGraph, HavePlainLinksWhereTheFileSaysSo) {
  auto planned = must(plan_hosts(far("a", "robot") + far("b", "", "a", ", via = \"tcp\"")));
  EXPECT_EQ(planned.links[0].sender_uri, "tcp-listen:0.0.0.0:7001?readers=1&stay=1");
  EXPECT_EQ(planned.links[0].reader_uri, "tcp:10.0.0.2:7001?wait=60");
}

TEST(HostsOfAGraph, ShareATopicOfDdsWhereTheFileSaysSo) {
  const HostPlaces places = {{"", {"", "", "F0"}},
                             {"robot", {"10.0.0.2", "10.0.0.1", "F1"}},
                             {"lab", {"10.0.0.3", "10.1.0.1", "F2"}}};
  const std::string dds = ", via = \"dds\"", dropped = dds + ", keep = \"latest\"";
  auto planned =
      must(plan_hosts(far("a", "robot") + far("b", "lab", "a", dropped) +
                          far("c", "", "a", dds + ", keep = 3, rate = 5, memory = 1000") +
                          far("d", "robot", "a") + far("e", "lab", "a"),
                      places));
  const auto& links = planned.links;
  EXPECT_EQ(links[0].sender_uri, "dds:t/a/out?readers=2&stay=1&interface=10.0.0.2&keep=3");
  EXPECT_EQ(links[0].reader_uri, "dds:t/a/out?wait=60&interface=10.0.0.3&keep=latest");
  EXPECT_EQ(links[1].sender_uri, links[0].sender_uri);
  EXPECT_EQ(links[1].reader_uri,
            "dds:t/a/out?wait=60&interface=10.0.0.1&keep=3&memory=1000&rate=5");
  EXPECT_TRUE(links[2].reader_uri.starts_with("shm:")) << links[2].reader_uri;
  EXPECT_TRUE(links[3].reader_uri.starts_with("tls:")) << links[3].reader_uri;
  EXPECT_EQ(values_of(planned.modules[0], "--out").size(), 3U);
  // One reader with keep = "all" makes the writer wait; the host of hc run may have several
  // addresses.
  planned = must(plan_hosts(
      far("a", "") + far("b", "lab", "a", dropped) + far("c", "robot", "a", dds), places));
  EXPECT_EQ(planned.links[0].sender_uri,
            "dds:t/a/out?readers=2&stay=1&interface=10.0.0.1,10.1.0.1");
}

TEST(HostsOfAGraph, HaveAddressesOfVersion4ForDds) {
  const auto refused = plan_hosts(far("a", "lab") + far("b", "robot", "a", ", via = \"dds\""));
  EXPECT_EQ(
      refused.error().detail,
      "g.toml:14: dds needs the IPv4 address of host lab, not fe80::3: set address = \"…\" in "
      "its table");
  EXPECT_EQ(wrong(kHosts + "[modules.java]\nhost = \"robot\"\n" +
                  far("b", "", "java", ", via = \"dds\"")),
            "g.toml:12: no transport from java.out to b.in: module java supports tcp, tcp-listen, "
            "module b supports dds, shm, tcp, tcp-listen, tls, tls-listen, unix, unix-listen; it "
            "takes dds at both ends");
}

TEST(HostsOfAGraph, AreGivenToAllModulesOfAnIncludedGraph) {
  const std::string outer = kHosts + "[graphs.head]\nfile = \"head.toml\"\nhost = \"robot\"\n" +
                            "[graphs.head.modules.c]\nhost = \"lab\"\n";
  auto planned = must(plan(outer, {{"head.toml", far("a", "") + far("b", "lab") + far("c", "")}},
                           nullptr, {}, kPlaces));
  EXPECT_EQ(planned.modules[0].host, "robot");
  EXPECT_EQ(planned.modules[1].host, "lab");
  EXPECT_EQ(planned.modules[2].host, "lab");
  // An empty host is that of hc run.
  planned = must(plan(outer + "[graphs.head.modules.a]\nhost = \"\"\n",
                      {{"head.toml", far("a", "") + far("b", "lab") + far("c", "")}}, nullptr, {},
                      kPlaces));
  EXPECT_EQ(planned.modules[0].host, "");
  // The including file's declaration of a host overrides the included one.
  const std::string inner = "[hosts.robot]\nssh = \"other\"\n";
  EXPECT_EQ(wrong(outer, {{"head.toml", inner + far("a", "robot") + far("c", "")}}), "");
  EXPECT_EQ(wrong("[graphs.one]\nfile = \"a\"\n[graphs.two]\nfile = \"a\"\n",
                  {{"a", inner + far("a", "robot")}}),
            "a:2: duplicate host \"robot\"");
}

TEST(HostsOfAGraph, AreChecked) {
  EXPECT_EQ(wrong(kHosts + far("a", "robt")),
            "g.toml:10: no host \"robt\", did you mean \"robot\"?");
  EXPECT_EQ(wrong("[hosts.Robot]\nssh = \"r\"\n" + far("a", "")),
            "g.toml:2: host name \"Robot\" is not snake_case");
  EXPECT_EQ(wrong("[hosts.robot]\n" + far("a", "")), "g.toml:2: \"ssh\" is missing in host robot");
  for (const char* ssh : {"\"-oProxyCommand=x\"", "[]", "[\"robot\", \"-v\"]"})
    EXPECT_EQ(wrong("[hosts.robot]\nssh = " + std::string(ssh) + "\n" + far("a", "")),
              "g.toml:3: \"ssh\" must be a destination, such as \"pi@robot\", or a list that ends "
              "with it");
  EXPECT_EQ(wrong("[hosts.robot]\nssh = \"r\"\nport = 22\n" + far("a", "")),
            "g.toml:4: unknown key \"port\" in host robot");
  EXPECT_EQ(wrong(far("a", "") + far("b", "", "a", ", via = \"tls\"")),
            "g.toml:6: \"via\" is for a link between hosts, and a and b run on the same");
  EXPECT_EQ(
      wrong(kHosts + "[modules.java]\nhost = \"robot\"\n" + far("b", "", "java")),
      "g.toml:12: no transport from java.out to b.in: module java supports tcp, tcp-listen, "
      "module b supports dds, shm, tcp, tcp-listen, tls, tls-listen, unix, unix-listen; it takes "
      "tls-listen at java and tls at b; via = \"tcp\" would be neither encrypted nor "
      "authenticated");
}

/// A camera on the robot, and its reader.
std::string seen(const std::string& policy, const std::string& port = "any",
                 const std::string& host = "", const std::string& camera = "camera") {
  return "[modules.camera]\nhost = \"robot\"\nprogram = \"" + camera +
         "\"\n[modules.fixed]\nhost = \"" + host + "\"\ninputs." + port + " = { from = \"camera." +
         (camera == "far" ? "out" : "image") + "\", " + policy + " }\n";
}

TEST(HostsOfAGraph, HaveImagesConvertedByTheirSender) {
  const std::string policy = R"(as = "jpeg", quality = 80, scale = 0.5)";
  auto planned = must(plan_hosts(seen(policy)));
  EXPECT_EQ(planned.links[0].sender_uri,
            "tls-listen:0.0.0.0:7001?readers=1&stay=1&key=/proc/self/fd/3&peer=F0&keep=latest&as="
            "jpeg&quality=80&scale=0.5");
  EXPECT_EQ(planned.links[0].reader_uri, "tls:10.0.0.2:7001?wait=60&key=/proc/self/fd/3&peer=F1");
  // On one host too, over shared memory with its own sending end.
  planned = must(plan_hosts(seen(policy, "any", "robot")));
  EXPECT_EQ(
      planned.links[0].sender_uri,
      "shm:t.camera.image.fixed.any?readers=1&stay=1&keep=latest&as=jpeg&quality=80&scale=0.5");
}

TEST(HostsOfAGraph, HaveImagesFollowTheBandwidth) {
  const std::string policy = R"(bandwidth = "2 MB/s", idle_rate = 0.5, rate = 20)";
  auto planned = must(plan_hosts(seen(policy)));
  EXPECT_EQ(planned.links[0].sender_uri,
            "tls-listen:0.0.0.0:7001?readers=1&stay=1&key=/proc/self/fd/3&peer=F0&keep=latest&"
            "bandwidth=2MB/s&idle_rate=0.5&rate=20");
  EXPECT_EQ(planned.links[0].policy.at("bandwidth"), "2 MB/s");
  // Over shared memory the reader holds messages back, and the sender adapts them.
  planned = must(plan_hosts(seen(policy, "any", "robot")));
  EXPECT_EQ(planned.links[0].sender_uri,
            "shm:t.camera.image.fixed.any?readers=1&stay=1&keep=latest&bandwidth=2MB/s&idle_rate="
            "0.5");
  EXPECT_TRUE(planned.links[0].reader_uri.ends_with("&keep=latest&rate=20&bandwidth=2MB/s"))
      << planned.links[0].reader_uri;
}

TEST(HostsOfAGraph, HaveNothingConvertedThatCannotBe) {
  EXPECT_EQ(wrong(kHosts + seen("bandwidth = \"2M\"")),
            "g.toml:13: option bandwidth is from 1 kB/s to 4 GB/s, as in 500 kB/s, 2 MB/s or 5 "
            "Mbit/s, not \"2M\"");
  EXPECT_EQ(wrong(kHosts + seen("bandwidth = \"2 MB/s\"", "in")),
            "g.toml:13: camera.image: bandwidth: scale changes the size of images, and the input "
            "takes rgb_image 640 x 480 of 3 x u8; set scale");
  EXPECT_EQ(wrong(kHosts + seen("bandwidth = 5000, scale = 1", "in")), "");
  EXPECT_EQ(wrong(kHosts + seen("idle_rate = 0")),
            "g.toml:13: option idle_rate is a number from 0.01 to 1000");
  for (const char* key : {"bandwidth = 5000", "idle_rate = 1"})
    EXPECT_TRUE(
        wrong(kHosts + seen(key, "any", "", "far"))
            .starts_with("g.toml:13: module camera cannot have \"" + std::string(key).substr(0, 9)))
        << key;
  EXPECT_EQ(wrong(kHosts + seen("scale = 1.5")),
            "g.toml:13: option scale is a number from 0.01 to 1");
  EXPECT_EQ(wrong(kHosts + seen("quality = 80")), "g.toml:13: option quality needs as=jpeg");
  EXPECT_EQ(wrong(kHosts + seen("as = \"gif\"")),
            "g.toml:13: option as is text, binary, zstd or jpeg");
  EXPECT_EQ(wrong(kHosts + seen("as = 1.5")),
            "g.toml:13: \"as\" must be a whole number or a string");
  EXPECT_EQ(wrong(kHosts + seen("scale = true")),
            "g.toml:13: \"scale\" must be a number or a string");
  EXPECT_EQ(wrong(kHosts + seen("scale = 0.5", "in")),
            "g.toml:13: camera.image: scale changes the size of images, and the input takes "
            "rgb_image 640 x 480 of 3 x u8");
  EXPECT_EQ(wrong(kHosts + seen("as = \"jpeg\"", "in")), "");
  EXPECT_EQ(wrong(kHosts + seen("scale = 0.5", "any", "", "far")),
            "g.toml:13: module camera cannot have \"scale\": its program does not support "
            "--control; see spec/module.md, sections 3 and 6");
  EXPECT_EQ(wrong("[modules.router]\ninputs.in = { from = \"tcp-listen:1\", scale = 0.5 }\n"),
            "g.toml:3: a link from outside cannot have scale: its sender sets it");
  EXPECT_EQ(wrong("[modules.workspace]\noutputs.focus = { to = \"tcp:h:1\", as = \"jpeg\" }\n"),
            "g.toml:3: workspace.focus: as: R21 jpeg is for images of 1 or 3 components of "
            "u8, not table of 1 x i32");
}

}  // namespace
}  // namespace hc
