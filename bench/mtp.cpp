// SPDX-License-Identifier: Apache-2.0
// The wire format beside plain loops over std::to_chars and std::from_chars, in one run. Counters
// named `ratio` are not here: scripts/bench divides the medians.
#include <benchmark/benchmark.h>

#include <charconv>
#include <cstring>
#include <random>
#include <vector>

#include <hc/compress/compress.h>
#include <hc/mtp/codec.h>
#include <hc/mtp/text.h>
#include <hc/testing/decode.h>

namespace {

constexpr std::int64_t kTime = 1763683200123456789;

hc::Header example() {
  hc::Header header;
  header.src = 12;
  header.seq = 1042;
  header.time = hc::unix_time(kTime);
  header.mode = 1;
  header.coord = 3;
  header.width = header.height = 1;
  return header;
}

void header_format(benchmark::State& state) {
  hc::Header header = example();
  char line[hc::kMaxHeaderBytes];
  for (auto _ : state) {
    benchmark::DoNotOptimize(header);
    benchmark::DoNotOptimize(hc::format_header(header, line));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(header_format);

void header_format_reference(benchmark::State& state) {
  std::int64_t fields[11] = {1, 12, 0, 1042, 8, kTime, 10390, 1, 3, 1, 1};
  char line[hc::kMaxHeaderBytes];
  for (auto _ : state) {
    benchmark::DoNotOptimize(fields);
    char* at = line;
    for (std::int64_t field : fields) {
      at = std::to_chars(at, line + sizeof line, field).ptr;
      *at++ = ' ';
    }
    at[-1] = '\n';
    benchmark::DoNotOptimize(at);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(header_format_reference);

void header_parse(benchmark::State& state) {
  std::string line = hc::text(example());
  for (auto _ : state) {
    benchmark::DoNotOptimize(line.data());
    benchmark::ClobberMemory();
    auto header = hc::parse_header(line);
    benchmark::DoNotOptimize(header);
  }
}
BENCHMARK(header_parse);

void header_parse_reference(benchmark::State& state) {
  std::string line = hc::text(example());
  for (auto _ : state) {
    benchmark::DoNotOptimize(line.data());
    benchmark::ClobberMemory();
    std::int64_t fields[11];
    const char *at = line.data(), *end = at + line.size();
    for (std::int64_t& field : fields) at = std::from_chars(at, end, field).ptr + 1;
    benchmark::DoNotOptimize(fields);
  }
}
BENCHMARK(header_parse_reference);

/// 100 rows of 10 doubles as sensors give them, or with all their digits.
std::vector<double> doubles(bool all_digits) {
  std::mt19937_64 random(1);
  std::vector<double> numbers(1000);
  for (double& number : numbers) {
    number = std::uniform_real_distribution<double>(-10, 10)(random);
    if (!all_digits) number = static_cast<double>(static_cast<int>(number * 1000)) / 1000;
  }
  return numbers;
}

hc::Header doubles_header() {
  hc::Header header;
  header.info = {hc::MatrixType::Table, 1, hc::Scalar::F64, hc::Encoding::Text};
  header.width = 10;
  header.height = 100;
  return header;
}

void doubles_write(benchmark::State& state) {
  auto numbers = doubles(state.range(0) != 0);
  hc::Header header = doubles_header();
  std::string text;
  for (auto _ : state) {
    text.clear();
    hc::append_text(header, std::as_bytes(std::span(numbers)), text);
    benchmark::DoNotOptimize(text.data());
  }
}
BENCHMARK(doubles_write)->Arg(0)->Arg(1);

void doubles_write_reference(benchmark::State& state) {
  auto numbers = doubles(state.range(0) != 0);
  std::vector<char> text(numbers.size() * 32);
  for (auto _ : state) {
    char* at = text.data();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      at = std::to_chars(at, at + 32, numbers[i]).ptr;
      *at++ = i % 10 == 9 ? '\n' : ' ';
    }
    benchmark::DoNotOptimize(at);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(doubles_write_reference)->Arg(0)->Arg(1);

void doubles_read(benchmark::State& state) {
  auto numbers = doubles(state.range(0) != 0);
  hc::Header header = doubles_header();
  std::string text;
  hc::append_text(header, std::as_bytes(std::span(numbers)), text);
  for (auto _ : state) {
    hc::TextRows rows(header);
    auto used = rows.read(text, 0, reinterpret_cast<std::byte*>(numbers.data()));
    benchmark::DoNotOptimize(used);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(doubles_read)->Arg(0)->Arg(1);

void doubles_read_reference(benchmark::State& state) {
  auto numbers = doubles(state.range(0) != 0);
  std::string text;
  hc::append_text(doubles_header(), std::as_bytes(std::span(numbers)), text);
  for (auto _ : state) {
    const char *at = text.data(), *end = at + text.size();
    for (double& number : numbers) at = std::from_chars(at, end, number).ptr + 1;
    benchmark::DoNotOptimize(at);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(doubles_read_reference)->Arg(0)->Arg(1);

/// An SVGA image in memory: what decoding costs beside copying it.
void image_decode(benchmark::State& state) {
  std::string bytes = hc::encode(
      std::move(hc::Draft::make({hc::MatrixType::RgbImage, 3, hc::Scalar::U8, hc::Encoding::Binary},
                                600, 800))
          .finish());
  hc::Message message;
  for (auto _ : state) {
    auto used = hc::decode(std::as_bytes(std::span(bytes)), message);
    benchmark::DoNotOptimize(used);
    benchmark::DoNotOptimize(message.elements.data());
  }
}
BENCHMARK(image_decode);

void image_decode_reference(benchmark::State& state) {
  std::vector<char> from(1'440'000), to(from.size());
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(image_decode_reference);

/// What refusing a hostile header costs, its error line included.
void hostile_header(benchmark::State& state) {
  std::string bytes = "1 7 0 0 8 0 40101 1 7 9223372036854775808 9223372036854775808\n";
  hc::Message message;
  for (auto _ : state) {
    auto used = hc::decode(std::as_bytes(std::span(bytes)), message);
    benchmark::DoNotOptimize(used);
  }
}
BENCHMARK(hostile_header);

/// The same of a zstd frame that holds more than the header promises.
void hostile_zstd(benchmark::State& state) {
  auto zeros = hc::Draft::make({hc::MatrixType::Map, 1, hc::Scalar::U8, hc::Encoding::Binary}, 1,
                               100'000'000);
  std::memset(zeros.elements().data(), 0, zeros.elements().size());
  auto packed = *hc::compress(std::move(zeros).finish(), hc::Encoding::Zstd);
  packed.header.width = 1;
  for (auto _ : state) {
    auto refused = hc::expand(packed);
    benchmark::DoNotOptimize(refused);
  }
}
BENCHMARK(hostile_zstd);

}  // namespace
