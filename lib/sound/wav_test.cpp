// SPDX-License-Identifier: Apache-2.0
#include <sound/wav.h>

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <string>

#include <gtest/gtest.h>
#include <hc/testing/files.h>
#include <hc/testing/must.h>

namespace {

using hc::audio::Format;
using hc::audio::WavReader;
using hc::audio::WavWriter;

class Wav : public testing::Test {
 protected:
  Wav() : path("/tmp/hc_wav_" + std::to_string(::getpid()) + ".wav") {}
  ~Wav() override { std::filesystem::remove(path); }
  void save(const std::string& bytes) const {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::ssize(bytes));
  }
  [[nodiscard]] std::string why_not(const std::string& bytes) const {
    save(bytes);
    auto reader = WavReader::open(path);
    return reader ? "taken" : reader.error().detail.substr(path.size() + 2);
  }
  [[nodiscard]] std::vector<std::int16_t> samples(std::size_t at_once = 1000) const {
    auto reader = WavReader::open(path);
    EXPECT_TRUE(reader) << reader.error().text();
    std::vector<std::int16_t> all, some(at_once);
    while (true) {
      auto frames = reader->read(some);
      EXPECT_TRUE(frames);
      if (!frames || *frames == 0) return all;
      all.insert(all.end(), some.begin(),
                 some.begin() + static_cast<std::ptrdiff_t>(*frames) * reader->format().channels);
    }
  }
  std::string path;
};

std::string le(std::uint32_t value, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
  return bytes;
}

std::string chunk(const std::string& name, const std::string& data) {
  return name + le(static_cast<std::uint32_t>(data.size()), 4) + data +
         std::string(data.size() % 2, '\0');
}

std::string format(std::uint32_t kind, std::uint32_t channels, std::uint32_t rate,
                   std::uint32_t bits) {
  const auto frame = channels * bits / 8;
  return chunk("fmt ", le(kind, 2) + le(channels, 2) + le(rate, 4) + le(rate * frame, 4) +
                           le(frame, 2) + le(bits, 2));
}

std::string riff(const std::string& chunks) {
  return "RIFF" + le(static_cast<std::uint32_t>(chunks.size() + 4), 4) + "WAVE" + chunks;
}

TEST_F(Wav, what_was_written_is_read) {
  std::vector<std::int16_t> some;
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) some.push_back(static_cast<std::int16_t>(random()));
  auto writer = hc::must(WavWriter::create(path, {22050, 2}));
  EXPECT_TRUE(samples().empty());
  ASSERT_TRUE(writer.write(std::span(some).first(600)));
  // Also complete while the writer is still open.
  EXPECT_EQ(samples(), std::vector<std::int16_t>(some.begin(), some.begin() + 600));
  ASSERT_TRUE(writer.write(std::span(some).subspan(600)));
  EXPECT_EQ(samples(7), some);  // room for three and a half frames
  EXPECT_EQ(WavReader::open(path)->format(), (Format{22050, 2}));
  EXPECT_EQ(WavReader::open(path)->frames(), 1000);
}

TEST_F(Wav, the_header_is_as_specified) {
  auto writer = WavWriter::create(path, {8000, 1});
  const std::int16_t one = 0x0102;
  ASSERT_TRUE(writer && writer->write({&one, 1}));
  EXPECT_EQ(hc::bytes_of(path), riff(format(1, 1, 8000, 16) + chunk("data", "\x02\x01")));
}

TEST_F(Wav, a_file_that_has_contents_stays) {
  const std::vector<std::int16_t> some = {1, 2, 3, 4}, other = {5, 6};
  ASSERT_TRUE(WavWriter::create(path, {8000, 1})->write(some));
  auto beside = WavWriter::create(path, {8000, 1});
  ASSERT_TRUE(beside && beside->write(other));
  EXPECT_TRUE(beside->path().ends_with("_2.wav")) << beside->path();
  EXPECT_EQ(samples(), some);
  std::filesystem::remove(beside->path());
  EXPECT_FALSE(WavWriter::create("/dev/full", {8000, 1}));
}

TEST_F(Wav, a_descriptor_by_name_is_written_behind_what_it_has) {
  save("shell ");
  const int own = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const std::vector<std::int16_t> some = {1, 2, 3, 4};
  for (int i = 0; i < 2; ++i) {
    auto writer = hc::must(WavWriter::create("/proc/self/fd/" + std::to_string(own), {8000, 1}));
    for (const auto sample : some) ASSERT_TRUE(writer.write(std::span(&sample, 1)));
  }
  ::close(own);
  const auto sound =
      riff(format(1, 1, 8000, 16) + chunk("data", std::string("\1\0\2\0\3\0\4\0", 8)));
  EXPECT_EQ(hc::bytes_of(path), "shell " + sound + sound);
}

TEST_F(Wav, all_kinds_of_samples) {
  const std::string two = std::string("\x00\xFF", 2);
  save(riff(format(1, 1, 8000, 8) + chunk("data", two)));
  EXPECT_EQ(samples(), (std::vector<std::int16_t>{-32768, 32512}));
  save(riff(format(1, 1, 8000, 24) + chunk("data", std::string("\x55\x01\x80\xAA\xFF\x7F", 6))));
  EXPECT_EQ(samples(), (std::vector<std::int16_t>{-32767, 32767}));
  save(riff(format(1, 1, 8000, 32) + chunk("data", std::string("\x55\x55\xFE\xFF", 4))));
  EXPECT_EQ(samples(), (std::vector<std::int16_t>{-2}));
  save(riff(format(3, 1, 8000, 32) +
            chunk("data", le(0x3F800000, 4) + le(0xBF800000, 4) + le(0x7FC00000, 4) +
                              le(0x7F800000, 4) + le(0x3F000000, 4))));  // 1 -1 nan inf 0.5
  EXPECT_EQ(samples(), (std::vector<std::int16_t>{32767, -32767, 0, 32767, 16384}));
  save(riff(chunk("fmt ", le(0xFFFE, 2) + le(1, 2) + le(8000, 4) + le(16000, 4) + le(2, 2) +
                              le(16, 2) + le(22, 2) + le(16, 2) + le(4, 4) + le(1, 2) +
                              std::string(14, 'x')) +
            chunk("data", two)));
  EXPECT_EQ(samples(), (std::vector<std::int16_t>{-256}));
}

TEST_F(Wav, other_parts_are_passed_over) {
  save(riff(chunk("LIST", "odd") + format(1, 1, 8000, 16) + chunk("fact", "1234") +
            chunk("data", "ab") + chunk("tail", "more")));
  EXPECT_EQ(samples(), std::vector<std::int16_t>{0x6261});
}

TEST_F(Wav, sizes_are_not_believed) {
  const std::string begin = format(1, 1, 8000, 16);
  for (std::uint32_t size : {0U, 5U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    save(riff(begin + "data" + le(size, 4) + "abcd"));
    EXPECT_EQ(samples(), (std::vector<std::int16_t>{0x6261, 0x6463})) << size;
  }
  save(riff(begin + "data" + le(100, 4) + "abc"));  // half a frame at the end
  EXPECT_EQ(samples(), std::vector<std::int16_t>{0x6261});
}

TEST_F(Wav, refuses_what_is_none) {
  EXPECT_EQ(why_not(""), "not a WAV file");
  EXPECT_EQ(why_not("RIFF"), "not a WAV file");
  EXPECT_EQ(why_not("RIFX" + riff("").substr(4)), "not a WAV file");
  EXPECT_EQ(why_not(riff("")), "has no samples");
  EXPECT_EQ(why_not(riff(format(1, 1, 8000, 16))), "has no samples");
  EXPECT_EQ(why_not(riff(chunk("data", "abcd"))), "samples before their format");
  EXPECT_EQ(why_not(riff("LIST" + le(0xFFFFFFFF, 4))), "a chunk is larger than the file");
  EXPECT_EQ(why_not(riff(chunk("fmt ", "short") + chunk("data", ""))), "the format is truncated");
  EXPECT_EQ(why_not(riff(format(1, 0, 8000, 16) + chunk("data", ""))), "0 channels, not 1 to 8");
  EXPECT_EQ(why_not(riff(format(1, 65535, 8000, 16))), "65535 channels, not 1 to 8");
  EXPECT_EQ(why_not(riff(format(1, 1, 0, 16))), "a rate of 0 Hz");
  EXPECT_EQ(why_not(riff(format(1, 1, 4000000000, 16))), "a rate of 4000000000 Hz");
  EXPECT_EQ(why_not(riff(format(1, 1, 8000, 0))), "samples of kind 1 with 0 bits");
  EXPECT_EQ(why_not(riff(format(2, 1, 8000, 4))), "samples of kind 2 with 4 bits");
  EXPECT_EQ(why_not(riff(chunk(
                "fmt ", le(1, 2) + le(2, 2) + le(8000, 4) + le(0, 4) + le(3, 2) + le(16, 2)))),
            "frames of 3 bytes, not 4");
  std::string many;
  for (int i = 0; i < 1001; ++i) many += chunk("junk", "");
  EXPECT_EQ(why_not(riff(many)), "has more than 1000 parts");
}

TEST_F(Wav, no_cut_and_no_flipped_bit_does_harm) {
  const std::string whole =
      riff(chunk("LIST", "abcdef") + format(1, 2, 8000, 16) + chunk("data", std::string(64, 'x')));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    save(whole.substr(0, size));
    if (WavReader::open(path)) {
      EXPECT_LE(samples(64).size(), 32);
    }
  }
  std::mt19937 random(11);
  for (int i = 0; i < 500; ++i) {
    std::string bytes = whole;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] ^= static_cast<char>(random());
    save(bytes);
    auto reader = WavReader::open(path);
    if (!reader) continue;
    std::vector<std::int16_t> room(1024);
    auto frames = hc::must(reader->read(room));
    EXPECT_LE(frames, whole.size());
  }
}

TEST_F(Wav, says_what_cannot_be_opened) {
  EXPECT_EQ(WavReader::open("/no/such.wav").error().text(),
            "NotFound: /no/such.wav: No such file or directory");
  EXPECT_EQ(WavReader::open("/tmp").error().detail, "/tmp: not a regular file");
  EXPECT_EQ(WavWriter::create("/no/such.wav", {8000, 1}).error().text(),
            "NotFound: open(/no/such.wav): No such file or directory");
}

}  // namespace
