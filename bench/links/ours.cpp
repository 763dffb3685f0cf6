// SPDX-License-Identifier: Apache-2.0
// Our transports, whichever the URIs name: a table of bytes with a header as modules send it. Of 96
// bytes the header line takes some 53, as on a wire; of larger sizes the elements alone are
// counted.
#include <vector>

#include <hc/link/link.h>
#include <transports/all.h>

#include "harness.h"

namespace {

using bench::Setup;

constexpr std::int64_t kFirst = 1'000'000;  // of as many digits as all others of a run
constexpr hc::Time kTime = hc::unix_time(1'763'683'200'123'456'789);

hc::Uri uri_of(std::string text, const Setup& setup) {
  const std::pair<std::string_view, std::string> names[] = {
      {"{link}", setup.link},
      {"{folder}", setup.folder},
      {"{port}", std::to_string(setup.port)},
      {"{readers}", std::to_string(setup.readers)}};
  for (const auto& [name, value] : names)
    for (std::size_t at = 0; (at = text.find(name)) != std::string::npos;)
      text.replace(at, name.size(), value);
  auto uri = hc::parse_uri(text);
  if (!uri) bench::fail(uri.error().text());
  return *uri;
}

hc::Header header_of(const Setup& setup) {
  hc::Header header;
  header.src = 12;
  header.seq = kFirst;
  header.time = kTime;
  header.mode = 1;
  header.coord = 3;
  header.info = {hc::MatrixType::Table, 1, hc::Scalar::U8, hc::Encoding::Binary};
  header.width = static_cast<std::int32_t>(setup.bytes);
  header.height = 1;
  if (setup.is_small()) {
    char line[hc::kMaxHeaderBytes];
    header.width -= static_cast<std::int32_t>(hc::format_header(header, line)) + 1;
  }
  return header;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup) {
    own_.header = header_of(setup);
    if (setup.is_small()) buffer_.resize(own_.header.element_bytes());
    own_.elements = buffer_;
    auto sink = hc::open_sink(uri_of(setup.sink, setup));
    if (!sink) bench::fail(sink.error().text());
    sink_ = std::move(*sink);
  }

  std::span<std::byte> loan() override {
    ++own_.header.seq;
    own_.header.time += std::chrono::milliseconds(1);
    if (!buffer_.empty()) return buffer_;
    draft_ = sink_->loan(own_.header);
    return draft_.elements();
  }

  void publish() override {
    if (!buffer_.empty())
      send(own_);
    else
      send(std::move(draft_).finish());
  }

  void resend() override {
    if (own_.elements.empty()) {
      loan();
      own_ = std::move(draft_).finish();
    }
    send(own_);
  }

 private:
  void send(const hc::Message& message) {
    if (auto sent = sink_->send(message); !sent) bench::fail(sent.error().text());
  }

  std::unique_ptr<hc::Sink> sink_;
  hc::Message own_;
  std::vector<std::byte> buffer_;  // elements of own_, if they are small
  hc::Draft draft_;                // if they are large
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup) {
    auto source = hc::open_source(uri_of(setup.source, setup));
    if (!source) bench::fail(source.error().text());
    source_ = std::move(*source);
  }

  std::span<const std::byte> receive() override {
    auto got = hc::receive(*source_, message_);
    if (!got) bench::fail(got.error().text());
    if (!*got) bench::fail("the link has ended");
    return message_.elements;
  }

 private:
  std::unique_ptr<hc::Source> source_;
  hc::Message message_;
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  return bench::run<Publisher, Subscriber>(argc, argv);
}
