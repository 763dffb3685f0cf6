// SPDX-License-Identifier: Apache-2.0
// Recordings of all formats; mcap_test.cpp tests those of MCAP in detail.
#include <sys/stat.h>

#include <array>
#include <limits>

#include <record/recording_test.h>

namespace hc::record {
namespace {

namespace fs = std::filesystem;

Result<std::unique_ptr<Writer>> open_folder(const std::string& folder,
                                            const std::vector<std::string>& streams) {
  WriterOptions options;
  options.streams = streams;
  return Writer::open(*place_of_streams(folder), options);
}

/// A message with this size of elements [byte].
Message sized(std::int32_t size) {
  Header header;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  header.width = size;
  header.height = 1;
  Draft draft = Draft::make(header);
  std::ranges::fill(draft.elements(), std::byte('a'));
  return std::move(draft).finish();
}

/// The number of messages of a file; checks that all are complete.
std::size_t count(const std::string& path) {
  const auto played = play(path);
  EXPECT_FALSE(played.error) << path << ": " << played.error->text();
  return played.messages.size();
}

class Recorded : public Recordings {
 protected:
  [[nodiscard]] Error refusal(const std::vector<std::string>& streams) const {
    return open_folder(kept, streams).error();
  }

  const std::string kept = in("kept");
};

TEST_F(Recorded, AnErrorLeavesNothingBehind) {
  const std::string too_long(300, 'x');
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(refusal({"eyes.left", too_long}).code, Code::System);
    EXPECT_FALSE(fs::exists(kept));
  }
  fs::create_directories(kept);
  EXPECT_EQ(refusal({"eyes.left", too_long}).code, Code::System);
  EXPECT_TRUE(fs::is_empty(kept));
}

TEST_F(Recorded, AnErrorLeavesWhatWasThere) {
  write("kept/eyes.left.mtp", "");
  WriterOptions options;
  options.streams = {"eyes.left", "eyes.right", std::string(300, 'x')};
  options.append = true;
  EXPECT_EQ(Writer::open(*place_of_streams(kept), options).error().code, Code::System);
  EXPECT_TRUE(fs::exists(kept + "/eyes.left.mtp"));
  EXPECT_FALSE(fs::exists(kept + "/eyes.right.mtp"));
}

TEST_F(Recorded, NothingIsLeftBehindWhereNoDescriptorsAre) {
  const auto empty = write("empty.mtp", "");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  bool is_open = false;
  for (rlim_t most = 3; most < 100 && !is_open; ++most) {
    const rlimit limit{most, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    is_open = open_folder(kept, {"eyes.left"}).has_value();
    EXPECT_EQ(Writer::open(must(place_of(empty)), {}).has_value(), is_open) << most;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_EQ(fs::exists(kept), is_open) << most;
    EXPECT_TRUE(fs::exists(empty)) << most;
  }
  EXPECT_TRUE(is_open);
}

TEST_F(Recorded, HasAFileOfEachStream) {
  auto made = std::move(*open_folder(kept, {"eyes.left", "eyes.right", "neck.pose"}));
  ASSERT_TRUE(made->add(0, sized(3)));
  ASSERT_TRUE(made->add(1, sized(100000)));
  ASSERT_TRUE(made->add(0, sized(4)));
  const auto& written = made->close();
  ASSERT_TRUE(written.status);
  EXPECT_EQ(written.place, kept);
  EXPECT_EQ(written.files.size(), 3U);
  EXPECT_EQ(written.messages, 3U);
  EXPECT_EQ(written.lost, 0U);
  EXPECT_EQ(bytes_of(kept + "/eyes.left.mtp"), encode(sized(3)) + encode(sized(4)));
  EXPECT_EQ(bytes_of(kept + "/eyes.right.mtp"), encode(sized(100000)));
  EXPECT_TRUE(fs::exists(kept + "/neck.pose.mtp"));
}

TEST_F(Recorded, OfAnEarlierProcessIsLeftAlone) {
  auto record_one = [&](const std::string& folder) {
    auto made = std::move(*open_folder(folder, {"a.out"}));
    EXPECT_TRUE(made->add(0, sized(1)));
    return made->close().place;
  };
  EXPECT_EQ(record_one(kept), kept);
  EXPECT_EQ(record_one(kept), kept + "_2");
  EXPECT_EQ(record_one(kept + "/"), kept + "_3");
  EXPECT_EQ((*open_folder(kept, {"b.out"}))->written().place, kept + "_4");
  for (const char* file : {"kept/a.out.mtp", "kept_2/a.out.mtp", "kept_3/a.out.mtp"})
    EXPECT_EQ(count(in(file)), 1U) << file;
}

TEST_F(Recorded, SaysTheFileThatItIsIn) {
  for (const char* name : {"x.mtp", "x_2.mtp", "x_3.mtp"}) {
    auto writer = writer_of(in("x.mtp"));
    EXPECT_EQ(writer->written().place, in(name));
    ASSERT_TRUE(writer->add(0, sized(1)));
    EXPECT_EQ(writer->close().files, std::vector{in(name)});
    EXPECT_EQ(count(in(name)), 1U);
  }
}

TEST_F(Recorded, WrongNamesAreRefused) {
  for (const auto& [streams, what] :
       {std::pair(std::vector<std::string>{""}, "\"\" cannot be a file name"),
        {{"../a.out"}, "\"../a.out\" cannot be a file name"},
        {{"a.out", "a.out"}, "\"a.out\" is given twice"}}) {
    const auto error = refusal(streams);
    EXPECT_EQ(error.code, Code::Invalid);
    EXPECT_EQ(error.detail, std::string("streams: ") + what);
  }
  EXPECT_FALSE(fs::exists(kept));
}

TEST_F(Recorded, WhereNoneCanBeMadeIsAnError) {
  const std::string below = write("file", "a") + "/kept";
  EXPECT_EQ(open_folder(below, {"a.out"}).error().detail, below + ": Not a directory");
  const std::string name(300, 'a');
  EXPECT_EQ(refusal({name}).detail, "open(" + kept + "/" + name + ".mtp): File name too long");
}

TEST_F(Recorded, OnAFullDiskHasWholeMessages) {
  for (const std::int32_t size : {30000, 100}) {  // written directly, and buffered
    const FullDisk full(100'000);
    auto made = std::move(*open_folder(kept, {"a.out", "b.out"}));
    Status recorded = made->add(1, sized(10));
    for (int i = 0; recorded && i < 20000; ++i) recorded = made->add(0, sized(size));
    ASSERT_FALSE(recorded);
    const auto& written = made->written();
    EXPECT_EQ(recorded.error().code, Code::System);
    EXPECT_EQ(recorded.error().detail, written.place + "/a.out.mtp: write(): File too large");
    EXPECT_EQ(made->add(1, sized(1)).error().detail, recorded.error().detail);
    EXPECT_EQ(made->close().status.error().detail, recorded.error().detail);
    const auto whole = count(written.place + "/a.out.mtp");
    EXPECT_GT(whole, 0U);
    EXPECT_EQ(count(written.place + "/b.out.mtp"), 1U);
    EXPECT_EQ(written.messages, whole + 1);
  }
}

using namespace std::chrono_literals;

constexpr Time kNow(1'763'683'200s), kNone;

class InOrder : public Recorded {
 protected:
  static Message at(Time time, std::int32_t seq, std::int32_t src = 7) {
    auto message = sized(3);
    message.header.time = time;
    message.header.seq = seq;
    message.header.src = src;
    return message;
  }
  std::string file(const std::string& name, const std::vector<Time>& times) const {
    std::string bytes;
    for (std::size_t i = 0; i < times.size(); ++i)
      bytes += encode(at(times[i], static_cast<std::int32_t>(i)));
    return write(name, bytes);
  }
};

TEST_F(InOrder, OfFilesAreReadByTimeWhateverTheyAreWrittenIn) {
  file("kept/a.left.mtp", {kNow + 1ns, kNow + 3ns, kNow + 5ns});
  file("kept/a.right.mtp", {kNow, kNow + 2ns, kNow + 6ns});
  const std::vector<std::string> order = {"a.right", "a.left", "a.right",
                                          "a.left",  "a.left", "a.right"};
  const auto whole = play({kept});
  EXPECT_EQ(whole.streams, order);
  std::string from = kept;
  for (const char* name : {"x.mcap", "again/"}) {
    from = copy({from}, name);
    const auto again = play({from});
    EXPECT_EQ(again.streams, order);
    EXPECT_EQ(again.messages, whole.messages);
    EXPECT_EQ(again.times, whole.times);
  }
  EXPECT_EQ(play({in("x.mcap")}, kNow + 3ns).streams.size(), 3U);
  EXPECT_EQ(play({kept + "?stream=a.left"}).messages.size(), 3U);
  const auto wrong = play({kept + "?stream=a.lft"});
  EXPECT_NE(wrong.error->detail.find("did you mean \"a.left\"?"), std::string::npos);
}

TEST_F(InOrder, AMessageWithoutATimeGoesWithTheOneBefore) {
  const auto first = play({file("a.mtp", {kNone, kNone, kNow, kNow + 5ns, kNone, kNow + 7ns})});
  EXPECT_EQ(first.times, (std::vector{kNow, kNow, kNow, kNow + 5ns, kNow + 5ns, kNow + 7ns}));
  EXPECT_EQ(play({copy({in("a.mtp")}, "a.mcap")}).times, first.times);
  // A file without any times does not make a recording span decades.
  const auto both = play({file("b.mtp", {kNone, kNone, kNone}), file("c.mtp", {kNow, kNow + 1ns})});
  EXPECT_EQ(both.times, (std::vector{kNow, kNow, kNow, kNow, kNow + 1ns}));
  EXPECT_LT(play({copy({in("b.mtp")}, "b.mcap")}).duration(), 60s);
}

TEST_F(InOrder, AFifoIsReadOnce) {
  ASSERT_EQ(::mkfifo(in("x.mtp").c_str(), 0600), 0);
  auto reader = Reader::open({must(place_of(in("x.mtp")))}, {});
  ASSERT_TRUE(reader) << reader.error().text();
  std::ofstream fifo(in("x.mtp"), std::ios::binary);  // holds up to 1 MiB
  for (int i = 0; i < 4; ++i) {
    auto message = sized(200'000);
    message.header.seq = i;
    message.header.time = i == 0 ? kNone : kNow;  // the first without a time
    fifo << encode(message);
  }
  fifo.close();
  Message message;
  for (int i = 0; i < 4; ++i) {
    auto got = receive(**reader, message);
    ASSERT_TRUE(got) << got.error().text();
    ASSERT_TRUE(*got) << i;
    EXPECT_EQ(message.header.seq, i);
  }
}

TEST_F(InOrder, AClockThatIsSetLosesNoMessageAndMakesNobodyWait) {
  const auto hour = 1h;
  const auto back =
      play({file("a.mtp", {kNow, kNow + 1s, kNow + 2s - hour, kNow + 3s - hour, kNow + 4s})});
  EXPECT_EQ(back.times.size(), 5U);
  EXPECT_EQ(back.duration(), 4s);
  EXPECT_TRUE(std::ranges::is_sorted(back.times));
  // After one maximal time, the following messages get the same.
  constexpr Time kMost = Time::max();
  const auto ahead = play({file("b.mtp", {kNow, kMost, kNow + 1s, kNow + 2s})});
  EXPECT_EQ(ahead.times, (std::vector{kNow, kMost, kMost, kMost}));
}

TEST_F(InOrder, LogTimesGoByTheMonotonicClock) {
  ManualClock clock;
  clock.set_wall(kNow);
  WriterOptions options;
  options.clock = &clock;
  options.last = std::chrono::seconds(10);
  options.chunk_bytes = 1;
  auto writer = writer_of(in("x.mcap"), options);
  const auto stream = *writer->add_stream("a.out");
  for (int i = 0; i < 60; ++i) {  // the wall clock is set back and forth each second
    ASSERT_TRUE(writer->add(stream, at({}, i)));
    clock.advance(std::chrono::seconds(1));
    clock.set_wall(kNow + (i % 2 == 0 ? 1h : -1h));
  }
  writer->save();
  const auto last = play({writer->close().files.at(0)});
  EXPECT_EQ(last.times.size(), 11U);
  EXPECT_EQ(last.duration(), 10s);
  EXPECT_EQ(last.times.back(), kNow + 59s);
}

TEST_F(InOrder, OneLinkMayCarrySeveralStreams) {
  auto writer = writer_of(in("x.mcap"));
  const std::array<int, 2> from{};  // two links
  for (int i = 0; i < 6; ++i)
    ASSERT_TRUE(
        writer->add(*writer->stream_of(&from[0], "eyes", 7 + i % 2), at(kNow, i, 7 + i % 2)));
  ASSERT_TRUE(writer->add(*writer->stream_of(&from[1], "eyes", 7),
                          at(kNow, 0)));  // another link of the same name
  const auto place = writer->close().place;
  for (const auto& [name, count] : {std::pair("eyes", 3U), {"eyes.src_8", 3U}, {"eyes_2", 1U}})
    EXPECT_EQ(play({place + "?stream=" + name}).messages.size(), count) << name;
}

TEST_F(InOrder, InMcapAreCopiedWithAllThatStandsBeside) {
  WriterOptions options;
  options.frames = "head 3 robot 1 2 3 0 0 0 1";
  for (const char* name : {"one/x.mcap", "two/x.mcap"}) {
    fs::create_directories(fs::path(in(name)).parent_path());
    auto writer = writer_of(in(name), options);
    const auto stream = *writer->add_stream("a.out");
    for (int i = 0; i < 9; ++i)
      ASSERT_TRUE(writer->add(stream, at(kNow + i * 1ns, i), kNow + i * 100ns));
    ASSERT_TRUE(writer->log({"a", Level::Info, "a line"}));
    ASSERT_TRUE(writer->metadata(name, {{"k", "v"}}));
  }
  const auto one = in("one/x.mcap"), two = in("two/x.mcap");
  // Also from a truncated file.
  const auto bytes = bytes_of(one);
  const auto cut = write("cut.mcap", bytes.substr(0, bytes.rfind("a.out") - 800));
  for (const auto& from : {one, cut}) {
    const auto mended = copy({from}, "mended.mcap");
    EXPECT_EQ(topics_of(summary_of(mended)), topics_of(summary_of(one)));
    EXPECT_EQ(play({mended}).messages, play({one}).messages);
    EXPECT_EQ(play({mended}).times, play({one}).times);
  }
  // Of two files with the same names, streams stay separate; frames and log are merged.
  const auto both = copy({one, two}, "both.mcap");
  EXPECT_EQ(topics_of(summary_of(both)), (std::map<std::string, std::uint64_t>{{"/a/out", 9},
                                                                               {"/a/out/mtp", 9},
                                                                               {"/a/out_2", 9},
                                                                               {"/a/out/mtp_2", 9},
                                                                               {"/rosout", 2},
                                                                               {"/tf_static", 2}}));
  EXPECT_EQ(play({both + "?stream=a.out_2"}).messages, play({two}).messages);
  // The same with a folder.
  const auto beside = copy({both, copy({one}, "kept/")}, "beside.mcap");
  EXPECT_EQ(play({beside + "?stream=a.out_3"}).messages, play({one}).messages);
}

TEST_F(InOrder, AFileThatIsCutOffEndsThatStreamAlone) {
  file("kept/a.mtp", {kNow, kNow + 2ns, kNow + 4ns});
  const auto cut = file("kept/b.mtp", {kNow + 1ns, kNow + 3ns});
  fs::resize_file(cut, fs::file_size(cut) - 2);
  const auto whole = play({kept});
  EXPECT_EQ(whole.streams, (std::vector<std::string>{"a", "b", "a", "a"}));
  ASSERT_TRUE(whole.error);
  EXPECT_EQ(whole.error->code, Code::Truncated);
  EXPECT_TRUE(whole.error->detail.starts_with(cut + ": ")) << whole.error->detail;
  // Counting reports it, too.
  const auto counted = *(*Reader::open({must(place_of(kept))}, {}))->streams(StreamDetail::Counts);
  EXPECT_TRUE(counted.at(0).status);
  EXPECT_EQ(counted.at(1).messages, 1U);
  ASSERT_FALSE(counted.at(1).status);
  EXPECT_EQ(counted.at(1).status.error().code, Code::Truncated);
}

TEST_F(InOrder, ThatGoOnContinueTheirFiles) {
  WriterOptions options;
  options.streams = {"a.out"};
  options.append = true;
  for (int i = 0; i < 3; ++i) {
    auto writer = writer_of(*place_of_streams(kept), options);
    ASSERT_TRUE(writer->add(0, at(kNow, i)));
  }
  EXPECT_EQ(count(kept + "/a.out.mtp"), 3U);
}

TEST_F(InOrder, NamesAndLinksAreToldApart) {
  using Kind = Place::Kind;
  fs::create_directories(kept);
  for (const auto& [word, kind] : {std::pair<std::string, Kind>{"x.mcap", Kind::Mcap},
                                   {"RUN.MCAP", Kind::Mcap},
                                   {"2025-11-25T13:00:00.mcap", Kind::Mcap},
                                   {"Run 1: eyes.mcap", Kind::Mcap},
                                   {"./run:1.mcap", Kind::Mcap},
                                   {"file:x.mcap", Kind::Mcap},
                                   {"x.mcap?stream=a.b", Kind::Mcap},
                                   {"x.mtp", Kind::File},
                                   {"13:00.mtp", Kind::File},
                                   {"odd?name&=.mtp", Kind::File},
                                   {"new/", Kind::Folder},
                                   {kept, Kind::Folder},
                                   {kept + "?stream=a.b", Kind::Folder},
                                   {"-", Kind::Link},
                                   {"tcp:robot:7000", Kind::Link},
                                   {"run:1.mcap", Kind::Link}})
    EXPECT_EQ(must(place_of(word)).kind, kind) << word;
  EXPECT_EQ(must(place_of("13:00.mcap")).path, "13:00.mcap");
  EXPECT_EQ(must(place_of("x.mcap?stream=a.b")).stream, "a.b");
  EXPECT_EQ(must(place_of("x.mcap?stream=a.b")).path, "x.mcap");
  EXPECT_EQ(must(place_of("RUN.MCAP")).name(), "RUN");
  for (const char* word : {"", "tcp:robot:7000?x"})
    EXPECT_EQ(place_of(word).error().code, Code::Invalid) << word;
  EXPECT_EQ(place_of_streams("kept")->kind, Kind::Folder);
  EXPECT_EQ(place_of_streams("13:00")->kind, Kind::Folder);
  for (const char* link : {"-", "tcp:robot:7000", "run:1"})
    EXPECT_EQ(place_of_streams(link).error().code, Code::Invalid) << link;
  for (const char* word : {"run:1.mcap", "tcp:robot:7000", "x.mcap?stream=a", "x.mcap?split=3"})
    EXPECT_EQ(Writer::open(must(place_of(word)), {}).error().code, Code::Invalid) << word;
}

}  // namespace
}  // namespace hc::record
