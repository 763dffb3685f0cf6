// SPDX-License-Identifier: Apache-2.0
#include <hc/module/module.h>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <limits>
#include <thread>

#include <hc/compress/compress.h>
#include <hc/module/arguments.h>
#include <hc/module/running_module_test.h>

namespace hc {
namespace {

Message stamped(Message message, int time, std::int32_t mode = 0) {
  message.header.time = unix_time(time);
  message.header.mode = mode;
  return message;
}

/// Runs a module; gives what it says on standard error.
std::string said(Module& module, const std::vector<std::string>& words, int status = 0) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run(module, words), status);
  return ::testing::internal::GetCapturedStderr();
}

/// Runs a module whose inputs have these messages; gives what its output "out" sends.
std::vector<Message> run_on(Module& module,
                            const std::vector<std::pair<std::string, std::vector<Message>>>& fed,
                            std::vector<std::string> words = {}) {
  words.insert(words.end(), {"--out", "out=inproc:run_on-out"});
  auto source = source_of("inproc:run_on-out");
  std::vector<std::unique_ptr<Sink>> sinks;
  for (const auto& [input, messages] : fed) {
    const std::string uri = "inproc:run_on-" + input;
    words.insert(words.end(), {"--in", input + "=" + uri});
    sinks.push_back(sink_of(uri));
    for (const auto& message : messages) EXPECT_TRUE(sinks.back()->send(message));
    EXPECT_TRUE(sinks.back()->close());
  }
  EXPECT_EQ(run(module, words), 0);
  std::vector<Message> sent;
  Message message;
  while (*receive(*source, message)) sent.push_back(message);
  return sent;
}

TEST(Module, AnswersEachMessageAndKeepsItsTime) {
  Module module{"double", "Doubles positions."};
  auto in = module.input("in", position(), "");
  auto out = module.output("out", position().in(3), "");
  auto factor = module.parameter("factor", 2.0, "", "");
  module.on(in, [&](const auto& message) {
    out.send({message.matrix().at(0, 0, 0) * *factor, 0.0, 0.0});
  });
  std::vector<Message> taken;
  for (int i = 1; i <= 3; ++i)
    taken.push_back(stamped(position().message({i * 1.0, 0.0, 0.0}), 1000 + i, 5));
  const auto sent = run_on(module, {{"in", taken}}, {"--factor", "10", "--address", "out=77"});
  ASSERT_EQ(sent.size(), 3U);
  for (int i = 1; i <= 3; ++i) {
    const Message& message = sent[static_cast<std::size_t>(i) - 1];
    EXPECT_EQ(view<double>(message)->at(0, 0, 0), 10.0 * i);
    EXPECT_EQ(message.header.time, unix_time(1000 + i));
    EXPECT_EQ(message.header.seq, i - 1);
    EXPECT_EQ(message.header.src, 77);
    EXPECT_EQ(message.header.mode, 5);
    EXPECT_EQ(message.header.coord, 3);
    EXPECT_EQ(message.header.ttl, 8);
  }
}

TEST(Module, ConvertsForTheLinkThatSaysSoAlone) {
  Module module{"camera", "Sends an image, and a number."};
  auto image = module.output("image", rgb_image().in(Coord::kLeftImage), "");
  auto number = module.output("number", table(), "");
  module.generate([&] {
    auto draft = image.loan(48, 64);
    std::ranges::fill(draft.numbers(), std::uint8_t{100});
    draft.header.time = unix_time(12);
    image.send(std::move(draft));
    number.send(1.5);
    module.stop();
  });
  auto whole = source_of("inproc:m9-whole"), small = source_of("inproc:m9-small"),
       other = source_of("inproc:m9-other");
  EXPECT_EQ(run(module, {"--out=image=inproc:m9-small?as=jpeg&quality=50&scale=0.5&keep=latest",
                         "--out=image=inproc:m9-whole", "--out=number=inproc:m9-other?scale=0.5"}),
            0);
  Header wanted = next(*whole).header;
  EXPECT_EQ(wanted.width, 64);
  EXPECT_EQ(wanted.info.encoding, Encoding::Binary);
  const Message compressed = next(*small);
  EXPECT_EQ(compressed.header.info.encoding, Encoding::Jpeg);
  const Message expanded = must(expand(compressed));
  wanted.width = 32;
  wanted.height = 24;
  EXPECT_EQ(expanded.header, wanted);
  EXPECT_NEAR(view<std::uint8_t>(expanded)->at(20, 30, 2), 100, 2);
  EXPECT_EQ(number_of(next(*other)), 1.5);  // is no image
}

TEST(Module, RefusesALinkThatCannotConvert) {
  Module module{"camera", "Sends nothing."};
  module.output("image", rgb_image(), "");
  EXPECT_NE(said(module, {"--out=image=inproc:m10?scale=2"}, 2)
                .find("option scale is a number from 0.01 to 1"),
            std::string::npos);
}

TEST(Module, SendsWhatIsOnDemandOnlyByALinkOfItsOwn) {
  const auto linked = [](const std::vector<std::string>& arguments) {
    Module module{"numbers", "Sends numbers."};
    auto always = module.output("always", table(), "a number");
    auto seldom = module.output("seldom", table(), "another", {.on_demand = true});
    std::pair<bool, bool> found;
    module.generate([&] {
      found = {always.linked(), seldom.linked()};
      module.stop();
    });
    EXPECT_EQ(run(module, arguments), 0);
    return found;
  };
  EXPECT_EQ(linked({}), std::pair(true, false));
  EXPECT_EQ(linked({"--out", "seldom=-"}), std::pair(false, true));
}

TEST(Module, ExpandsWhatIsCompressedAndCompressesWhenAsked) {
  Module module{"copy", "Copies images."};
  auto in = module.input("in", intensity_image(), "");
  auto out = module.output("out", intensity_image(), "");
  module.on(in, [&](const auto& message) {
    auto draft = out.loan(message.header.height, message.header.width);
    std::ranges::copy(message.matrix().numbers(), draft.matrix().numbers().begin());
    out.send(std::move(draft));
  });
  Draft draft = Draft::make(intensity_image().type.info, 8, 32);
  for (auto& byte : draft.elements()) byte = std::byte{99};
  const auto sent = run_on(module, {{"in", {*compress(std::move(draft).finish(), Encoding::Zstd)}}},
                           {"--encoding=jpeg"});
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].header.info.encoding, Encoding::Jpeg);
  EXPECT_EQ(view<std::uint8_t>(*expand(sent[0]))->at(3, 3), 99);
}

std::vector<Message> at_times(const std::vector<int>& times) {
  std::vector<Message> messages;
  for (auto time : times)
    messages.push_back(stamped(table().message({static_cast<double>(time)}), time, time));
  return messages;
}

/// A module with two inputs.
struct Pair : Module {
  Pair() : Module("pair", "Pairs.") {}
  Input<Kind<MatrixType::Table, double>> left = input("left", table(), "");
  Input<Kind<MatrixType::Table, double>> right = input("right", table(), "");
  Output<Kind<MatrixType::Table, double>> out = output("out", table(), "");
};

TEST(Module, TakesTwoInputsTogetherByTime) {
  Pair module;
  module.on(together(module.left, module.right), [&](const auto& a, const auto& b) {
    module.out.send({a.matrix().at(0, 0), b.matrix().at(0, 0)});
  });
  testing::internal::CaptureStderr();
  auto sent = run_on(module, {{"left", at_times({1, 2, 3, 5})}, {"right", at_times({2, 4, 5, 6})}});
  ASSERT_EQ(sent.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const int time = i == 0 ? 2 : 5;
    EXPECT_EQ(sent[i].header.time, unix_time(time));
    EXPECT_EQ(sent[i].header.mode, time);
    for (auto number : view<double>(sent[i])->numbers()) EXPECT_EQ(number, time);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "pair: left: dropped: no matching message (further drops are counted)\n"
            "pair: right: dropped: no matching message (further drops are counted)\n"
            "pair: left: dropped 2 unmatched, 0 on queue overflow\n"
            "pair: right: dropped 2 unmatched, 0 on queue overflow\n");
}

TEST(Module, R43_WhatIsMadeOfSeveralHasTheLatestTime) {
  Module module{"trio", "Takes three kinds."};
  auto one = module.input("one", table(), "");
  auto two = module.input("two", position<float>(), "");
  auto three = module.input("three", anything(), "");
  auto out = module.output("out", table(), "");
  module.on(together(one, two, three), [&](const auto& a, const auto& b, const Message& c) {
    EXPECT_EQ(a.header.time, Time());
    EXPECT_EQ(b.matrix().at(0, 0, 0), 0.5F);
    EXPECT_EQ(c.text(), "hello");
    out.send(1.0);
  });
  auto sent =
      run_on(module, {{"one", {stamped(table().message({1.0}), 0, 3)}},
                      {"two", {stamped(position<float>().message({0.5F, 0.0F, 0.0F}), 130, 7)}},
                      {"three", {stamped(string().message("hello"), 0)}}});
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].header.time, unix_time(130));
  EXPECT_EQ(sent[0].header.mode, 7);
}

TEST(Module, AnInputThatIsFarAheadWaitsToBeRead) {
  Pair module;
  module.on(together(module.left, module.right),
            [&](const auto&, const auto&) { module.out.send(1.0); });
  std::vector<int> often, seldom;
  for (int i = 1; i <= 60; ++i) {
    often.push_back(i);
    if (i % 20 == 0) seldom.push_back(i);
  }
  EXPECT_EQ(run_on(module, {{"left", at_times(often)}, {"right", at_times(seldom)}}).size(), 3U);
}

TEST(Module, AnInputWithoutALinkEndsWhatIsTakenTogetherWithIt) {
  Pair module;
  module.on(together(module.left, module.right), [](const auto&, const auto&) { FAIL(); });
  testing::internal::CaptureStderr();
  EXPECT_TRUE(run_on(module, {{"left", at_times({1})}}).empty());
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "pair: left: not read, since right has no link\n");
}

TEST(Module, AnImageMadeOfAnotherKeepsItsCoordinateSystem) {
  Module module{"grey", "Makes images grey."};
  auto in = module.input("in", rgb_image(), "");
  auto out = module.output("out", intensity_image(), "");
  module.on(in, [&](const auto& message) { out.send(message.numbers().first(1)); });
  const std::uint8_t pixel[] = {1, 2, 3};
  auto sent = run_on(
      module,
      {{"in", {rgb_image().in(Coord::kRightImage).message(pixel), rgb_image().message(pixel)}}});
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0].header.coord, Coord::kRightImage);
  EXPECT_EQ(sent[1].header.coord, 0);
}

TEST(Module, AScoreOfAnImageIsNotInItsCoordinateSystem) {
  Module module{"score", "Scores images."};
  auto in = module.input("in", rgb_image(), "");
  auto out = module.output("out", table(), "");
  module.on(in, [&](const auto&) { out.send(1.0); });
  const std::uint8_t pixel[] = {1, 2, 3};
  auto sent = run_on(module, {{"in", {rgb_image().in(Coord::kRightImage).message(pixel)}}});
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].header.coord, 0);
}

TEST(Module, ASetOfOneCoordinateSystemKeepsIt) {
  Module module{"mean", "Takes the mean."};
  auto one = module.input("one", position(), "");
  auto two = module.input("two", position(), "");
  auto out = module.output("out", position(), "");
  module.on(together(one, two), [&](const auto&, const auto&) { out.send({1.0, 2.0, 3.0}); });
  auto place = [](std::int32_t coord, int time) {
    return stamped(position().in(coord).message({0, 0, 0}), time);
  };
  auto sent =
      run_on(module, {{"one", {place(3, 1), place(3, 2)}}, {"two", {place(3, 1), place(2, 2)}}});
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0].header.coord, 3);
  EXPECT_EQ(sent[1].header.coord, 0);
}

TEST(Module, AnInputOfFiniteNumbersDropsOthersAndCountsThem) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Module module{"sum", "Adds."};
  auto in = module.input("in", rotation().of(1, 1).finite(), "");
  auto out = module.output("out", rotation(), "");
  module.on(in, [&](const auto& message) { out.send(message); });
  testing::internal::CaptureStderr();
  auto sent =
      run_on(module, {{"in",
                       {rotation().message({0.0, kNan, 0.0}), rotation().message({1.0, 2.0, 3.0}),
                        rotation().message({0.0, 0.0, std::numeric_limits<double>::infinity()})}}});
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "sum: in: dropped: NaN or infinity (further ones are counted, not logged)\n"
            "sum: total: 2 not finite\n");
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(view<double>(sent[0])->at(0, 0, 2), 3.0);
}

TEST(Module, ATimeoutFiresOnceEachTimeItIsStarted) {
  ManualClock clock;
  Module module{"watchdog", "Waits.", {.clock = &clock}};
  std::vector<std::string> log;
  int turns = 0;
  auto first = module.after(std::chrono::seconds(2), [&] { log.emplace_back("first"); });
  auto never = module.after(std::chrono::seconds(1), [&] { log.emplace_back("never"); });
  module.after(std::chrono::seconds(7), [&] { log.emplace_back("seventh"); });
  module.on_start([&] { never.stop(); });
  module.generate([&] {
    clock.advance(std::chrono::seconds(1));
    log.push_back(std::to_string(++turns));
    if (turns == 3) first.restart();
    if (turns == 4) first.restart(std::chrono::seconds(1));
    if (turns >= 7) module.stop();
  });
  EXPECT_EQ(run(module, {}), 0);
  EXPECT_EQ(log, (std::vector<std::string>{"1", "2", "first", "3", "4", "5", "first", "6", "7"}));
}

TEST(Module, ADescriptorIsReadWhenItIsReadable) {
  ManualClock clock;
  Module module{"device", "Reads a device.", {.clock = &clock}};
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  std::vector<int> read_at;
  int turns = 0;
  module.on_readable([&] { return pipe[0]; },
                     [&] {
                       char byte = 0;
                       EXPECT_EQ(::read(pipe[0], &byte, 1), 1);
                       read_at.push_back(turns);
                     });
  module.on_readable([] { return -1; }, [] { FAIL(); });
  module.generate([&] {
    ++turns;
    if (turns == 2) {
      EXPECT_EQ(::write(pipe[1], "ab", 2), 2);
    }
    if (turns != 3)
      clock.advance(
          std::chrono::milliseconds(1));  // a module that never waits looks once a millisecond
    if (turns >= 6) module.stop();
  });
  EXPECT_EQ(run(module, {}), 0);
  EXPECT_EQ(read_at, (std::vector<int>{2, 4}));
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(Module, OneInTheBackgroundYieldsTheProcessor) {
  Module module{"thinker", "Thinks.", {.background = true}};
  int nice = 0, policy = -1;
  module.generate([&] {
    nice = ::getpriority(PRIO_PROCESS, 0);
    policy = ::sched_getscheduler(0);
    module.stop();
  });
  std::thread([&] { EXPECT_EQ(run(module, {}), 0); }).join();  // this thread's alone
  EXPECT_EQ(nice, 10);
  EXPECT_EQ(policy, SCHED_BATCH);
}

TEST(Module, ABadMessageIsOneBadMessage) {
  Module module{"strict", "Takes positions."};
  auto in = module.input("in", any_of(position(), rgb_image()), "");
  int handled = 0;
  module.on(in, [&](const Message& message) {
    if (message.header.seq == 3) throw BadMessage("it is the third");
    if (message.header.seq == 4) throw std::out_of_range("a library does not take it");
    ++handled;
  });
  auto sink = sink_of("inproc:m4");
  auto reports = source_of("inproc:m4_reports");
  Message image;
  image.header.info = {MatrixType::RgbImage, 3, Scalar::U8, Encoding::Jpeg};
  image.header.width = image.header.height = 8;
  const std::string garbage(36, 'x');
  image.elements = std::as_bytes(std::span(garbage));
  Message frame = image;
  frame.header.info.encoding = Encoding::Zstd;
  Message refused = position().message({1.0, 2.0, 3.0});
  refused.header.seq = 3;
  Message unheard_of = refused;
  unheard_of.header.seq = 4;
  for (const Message& message : std::initializer_list<Message>{
           position().message({1.0, 2.0, 3.0}), table().message({1.0}), image, frame, refused,
           unheard_of, position().message({1.0, 2.0, 3.0})})
    ASSERT_TRUE(sink->send(message));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(
      said(module, {"--in", "inproc:m4", "--name", "north", "--manage=inproc:m4_reports"}),
      "north: in: dropped: Malformed: table 1 x 1 of 1 x f64 does not fit, the port takes position "
      "of 3 x f64 or rgb_image of 3 x u8 (further ones are counted, not logged)\n"
      "north: total: 5 bad at in\n");
  EXPECT_EQ(handled, 2);
  EXPECT_EQ(last_counters(*reports).at(0).at(15), 5);
}

TEST(Module, WhatALibraryThrowsIsLoggedWithoutItsSources) {
  Module module{"strict", "Takes no message."};
  auto in = module.input("in", table(), "");
  module.on(in, [](const auto&) {
    throw std::runtime_error(
        "OpenCV(4.6.0) ./alloc.cpp:73: error: (-4:Insufficient memory) Failed to allocate 8 bytes "
        "in function 'OutOfMemoryError'\n");
  });
  auto sink = sink_of("inproc:m_library");
  ASSERT_TRUE(sink->send(table().message({1.0})));
  ASSERT_TRUE(sink->close());
  EXPECT_TRUE(said(module, {"--in", "inproc:m_library"})
                  .starts_with("strict: in: dropped: System: OpenCV: (-4:Insufficient memory) "
                               "Failed to allocate 8 bytes "
                               "("));
}

TEST(Module, ABadSetIsDropped) {
  Pair module;
  int handled = 0;
  module.on(together(module.left, module.right), [&](const auto& one, const auto&) {
    if (one.header.time == unix_time(1)) throw BadMessage("it does not belong");
    ++handled;
  });
  ::testing::internal::CaptureStderr();
  run_on(module, {{"left", at_times({1, 2})}, {"right", at_times({1, 2})}});
  EXPECT_EQ(handled, 1);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("pair: total: 1 bad at "),
            std::string::npos);
}

TEST(Module, ABadFocusIsOneBadMessage) {
  Module module{"actor", "Acts."};
  auto in = module.input("in", table(), "");
  std::vector<bool> had;
  module.on(in, [&](const auto&) { had.push_back(module.has_focus()); });
  auto focus = sink_of("inproc:m_focus"), sink = sink_of("inproc:m_in");
  Message none = table<std::int32_t>().message({0});
  none.header.height = 0;
  none.elements = {};
  for (const Message& message : {Message(table<std::int32_t>().message({2})),
                                 Message(position().message({1.0, 2.0, 3.0})), none})
    ASSERT_TRUE(focus->send(message));
  ASSERT_TRUE(sink->send(table().message({1.0})));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(said(module, {"--in=inproc:m_in", "--in=focus=inproc:m_focus", "--mode=2"}),
            "actor: focus: dropped: the elements are position of 3 x f64, text, not plain i32 "
            "(further ones are counted, not logged)\nactor: total: 2 bad at focus\n");
  EXPECT_EQ(had, std::vector<bool>{true});
}

TEST(Module, AFileWithBadMessagesIsReadToItsEndAndAFailure) {
  const std::string file = ::testing::TempDir() + "bad_messages.mtp";
  {
    auto sink = sink_of("file:" + file);
    for (double number : {1.0, 2.0}) {
      ASSERT_TRUE(sink->send(position().message({1.0, 2.0, 3.0})));
      ASSERT_TRUE(sink->send(table().message({number})));
    }
    ASSERT_TRUE(sink->close());
  }
  Module module{"adder", "Adds."};
  auto in = module.input("in", table(), "");
  double sum = 0;
  module.on(in, [&](const auto& message) { sum += message.matrix().at(0, 0); });
  EXPECT_EQ(said(module, {"--in", "file:" + file}, 1),
            "adder: in: dropped: Malformed: R17 info: position does not fit, the port takes table "
            "(further ones are counted, not logged)\nadder: total: 2 bad at in\n");
  EXPECT_EQ(sum, 3);
  std::remove(file.c_str());
}

TEST(Module, EndsWhenNobodyReadsItAnyMore) {
  Module module{"source", "Makes numbers."};
  auto out = module.output("out", table(), "");
  module.generate([&] { out.send(1.0); });
  auto source = source_of("inproc:m5");
  std::thread reader([&] {
    for (int i = 0; i < 10; ++i) next(*source);
    source.reset();
  });
  EXPECT_EQ(run(module, {"--out", "inproc:m5"}), 0);
  reader.join();
}

TEST(Module, NoHandlerIsCalledAfterStop) {
  std::vector<std::string> log;
  Module module{"stopping", "Stops."};
  const auto stop = [&](const std::string& what) {
    log.push_back(what);
    module.stop();
  };
  std::vector<std::unique_ptr<Sink>> sinks;
  std::vector<std::string> words;
  for (const std::string name : {"one", "other", "left", "right"}) {
    sinks.push_back(sink_of("inproc:m8-" + name));
    ASSERT_TRUE(sinks.back()->send(table().message({1.0})));
    words.insert(words.end(), {"--in", name + "=inproc:m8-" + name});
  }
  for (const char* name : {"one", "other"})
    module.on(module.input(name, table(), ""), [&, name](const auto&) { stop(name); });
  module.on(together(module.input("left", table(), ""), module.input("right", table(), "")),
            [&](const auto&, const auto&) { stop("pair"); });
  module.every(std::chrono::nanoseconds(1), [&] { stop("timer"); });
  module.on_readable([] { return 0; }, [&] { stop("descriptor"); });
  module.on_end([&] { log.push_back("end"); });
  EXPECT_EQ(run(module, words), 0);
  EXPECT_EQ(log, (std::vector<std::string>{"one", "end"}));
}

TEST(Module, AGeneratorIsNotCalledAfterStop) {
  int calls = 0;
  Module module{"stopping", "Stops."};
  module.every(std::chrono::nanoseconds(1), [&] { module.stop(); });
  module.generate([&] { ++calls; });
  EXPECT_EQ(run(module, {}), 0);
  EXPECT_EQ(calls, 0);
}

TEST(Module, TheFirstOfTwoTimersMayStopIt) {
  int fired = 0;
  Module module{"stopping", "Stops."};
  for (int i = 0; i < 2; ++i)
    module.every(std::chrono::nanoseconds(1), [&] {
      ++fired;
      module.stop();
    });
  EXPECT_EQ(run(module, {}), 0);
  EXPECT_EQ(fired, 1);
}

TEST(Module, ReportsItsCounters) {
  Module module{"counted", "Counts."};
  auto in = module.input("in", table(), "");
  auto out = module.output("out", table(), "");
  module.on(in, [&](const auto&) { out.send({1.0, 2.0}); });
  auto sink = sink_of("inproc:m6-in");
  auto source = source_of("inproc:m6-out"), manage = source_of("inproc:m6-manage");
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(sink->send(table().message({1.0})));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(run(module, {"--in=inproc:m6-in", "--out=inproc:m6-out", "--manage=inproc:m6-manage"}),
            0);
  const auto rows = last_counters(*manage);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at(0), 7);
  EXPECT_EQ(rows[0].at(1), 7 * 8);
  EXPECT_EQ(rows[1].at(0), 7);
  EXPECT_EQ(rows[1].at(1), 7 * 16);
}

TEST(Module, ABadCommandLineIsStatusTwoAndOneLine) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--colour", "3"}, "no option \"--colour\"; parameters are: hue, on; see --help"},
      {{"--hue", "2"}, "parameter hue: \"2\" is not from 0 to 1"},
      {{"--hue"}, "--hue needs a value"},
      {{"--on=maybe"}, "parameter on: \"maybe\" is not true or false"},
      {{"--in", "up=-"}, "no input \"up\"; there are: in"},
      {{"--in", "in="}, "a URI cannot be empty: \"\""},
      {{"--address", "out=-1"}, "--address needs [PORT=]NUMBER, 0 to 2147483647, not \"out=-1\""},
      {{"--encoding", "png"}, "--encoding is text, binary, zstd or jpeg, not \"png\""},
      {{"--limit", "much"}, "--limit needs a number of bytes"},
      {{"0.5", "extra"}, "one argument too many: \"extra\"; see --help"},
  };
  for (const auto& [words, line] : cases) {
    Module module{"blob", "Finds blobs."};
    auto in = module.input("in", position(), "");
    auto out = module.output("out", position(), "");
    auto hue = module.parameter("hue", 0.3, "turn", "", {.min = 0, .max = 1, .positional = true});
    auto on = module.parameter("on", false, "", "");
    EXPECT_EQ(said(module, words, 2), "blob: Invalid: " + std::string(line) + "\n");
  }
}

TEST(Module, DescribesItself) {
  Module module{"blob", "Finds the \"largest\" blob."};
  auto in = module.input("image", any_of(rgb_image().in(7)), "image");
  auto depth = module.input("depth", anything(), "its depth");
  module.on(together(in, depth), [](const auto&, const auto&) {});
  auto out = module.output("target", position(), "centre");
  auto hue = module.parameter("hue", 0.5, "turn", "colour", {.min = 0, .max = 1});
  auto how = module.parameter("how", "fast", "", "way", {.choices = {"fast", "good"}});
  EXPECT_EQ(
      to_json(internal::description_of(module)),
      R"({"name":"blob","summary":"Finds the \"largest\" blob.","inputs":[{"name":"image","types":)"
      R"([{"type":"rgb_image","components":3,"scalar":"u8","width":0,"height":0,"coord":7}],)"
      R"("doc":"image"},{"name":"depth","types":[],"doc":"its depth"}],)"
      R"("together":[["image","depth"]],)"
      R"("outputs":[{"name":"target","types":[{"type":"position","components":3,)"
      R"("scalar":"f64","width":0,"height":0,"coord":0}],"encoding":"text","doc":"centre"}],)"
      R"("parameters":[{"name":"hue","type":"number","unit":"turn","default":0.5,"min":0,"max":1,)"
      R"("doc":"colour"},{"name":"how","type":"string","unit":"","default":"fast","choices":)"
      R"(["fast","good"],"doc":"way"}],)"
      R"("transports":["-","file","tcp","tcp-listen","unix","unix-listen","inproc","shm"],"control":true,)"
      R"("routes":false})");
  std::string help = internal::help(module);
  for (const char* part :
       {"Usage: hc blob", "image (rgb_image of 3 x u8 in coordinate system left_image (7))",
        "Taken together, by their times: image, depth\n",
        "colour [turn] (from 0 to 1; default 0.5)", "way: fast, good (default fast)",
        "--exclusive PORT", "--route 'PORT=URI WORDS'"})
    EXPECT_NE(help.find(part), std::string::npos) << help;
}

TEST(Module, AWrongUriIsWrongUsage) {
  Taker module{"sink"};
  for (const char* uri : {"tcp-listen:abc", "tcp:1?wait=x", "unix:"})
    EXPECT_TRUE(said(module, {"--in", uri}, 2).starts_with("sink: Invalid: ")) << uri;
  EXPECT_NE(said(module, {"--in", "file:/nowhere/at/all"}, 1).find("NotFound"), std::string::npos);
}

TEST(Module, HandlersFailWithOneLine) {
  Module module{"broken", "Fails."};
  auto in = module.input("in", table(), "");
  module.on(in, [](const auto&) { throw ModuleError("no camera"); });
  auto sink = sink_of("inproc:m7");
  ASSERT_TRUE(sink->send(table().message({1.0})));
  EXPECT_EQ(said(module, {"--in", "inproc:m7"}, 1), "broken: no camera\n");
}

TEST(Module, AFailedStatusEndsItAsItsCodeSays) {
  for (const auto& [code, status] : {std::pair{Code::System, 1}, {Code::Invalid, 2}}) {
    Module module{"broken", "Fails."};
    const Status failed = Error{code, "no camera"};
    module.on_start([&] {
      succeed_or_end({});
      succeed_or_end(failed);
    });
    EXPECT_NE(said(module, {}, status).find("no camera"), std::string::npos);
  }
}

}  // namespace
}  // namespace hc
