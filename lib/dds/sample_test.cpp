// SPDX-License-Identifier: Apache-2.0
// Samples without a network: to bytes in fragments of any size, and back.
#include <dds/sample.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include <hc/testing/decode.h>
#include <hc/testing/link_conformance.h>

namespace hc::dds {
namespace {

class DdsSample : public ::testing::Test {
 protected:
  ~DdsSample() override { ddsi_sertype_unref(type_); }

  Sample make(const Message& message) {
    return make_sample(*type_, encoder_.encode(message), message);
  }

  bool add(ddsi_serdata& sample, const Message& message) {
    return join(sample, encoder_.encode(message));
  }

  /// The bytes of a sample, padded to words, as sent in fragments.
  static std::string in_pieces(const ddsi_serdata& sample, std::size_t piece) {
    const std::size_t size = (ddsi_serdata_size(&sample) + 3) / 4 * 4;
    std::string bytes;
    for (std::size_t at = 0; at < size; at += piece) {
      const std::size_t count = std::min(piece, size - at);
      ddsrt_iovec_t reference{};
      auto* held = ddsi_serdata_to_ser_ref(&sample, at, count, &reference);
      bytes.append(static_cast<const char*>(reference.iov_base), reference.iov_len);
      ddsi_serdata_to_ser_unref(held, &reference);
    }
    return bytes;
  }

  Sample come(const std::string& bytes, std::size_t piece = 1 << 20) {
    std::vector<ddsrt_iovec_t> pieces;
    for (std::size_t at = 0; at < bytes.size(); at += piece)
      pieces.push_back({const_cast<char*>(bytes.data()) + at, std::min(piece, bytes.size() - at)});
    return Sample(
        ddsi_serdata_from_ser_iov(type_, SDK_DATA, pieces.size(), pieces.data(), bytes.size()));
  }

  /// The messages of a sample, and the error after them.
  std::vector<Message> read_all(const ddsi_serdata& sample, Error* error = nullptr,
                                const Limits& limits = {}) {
    std::vector<Message> messages;
    std::uint64_t bytes = 0;
    const auto read =
        read_messages(sample, limits, memo_, [&](Message message, std::uint64_t size) {
          messages.push_back(std::move(message));
          bytes += size;
        });
    if (error) *error = read ? Error{} : read.error();
    EXPECT_LE(read ? octets_of(sample) - bytes : 0, 3U);
    return messages;
  }
  Result<Message> read(const ddsi_serdata& sample) {
    Error error;
    auto messages = read_all(sample, &error);
    if (messages.size() != 1) return error;
    return std::move(messages[0]);
  }

  /// The error for a sample of these octets. @param count  of messages before it.
  std::string refusal(const std::string& octets, std::size_t count = 0) {
    const Pieces pieces = {std::as_bytes(std::span(octets)), {}, {}};
    return refusal_of(in_pieces(*make_sample(*type_, pieces, {}), octets.size() + 20), count);
  }
  std::string refusal_of(const std::string& bytes, std::size_t count = 0,
                         const Limits& limits = {}) {
    Error error;
    EXPECT_EQ(read_all(*come(bytes), &error, limits).size(), count);
    return error.detail.empty() ? "" : error.text();
  }

  ddsi_sertype* type_ = make_type();
  Encoder encoder_;
  internal::HeaderMemo memo_;
};

TEST_F(DdsSample, IsTheMessageInASequenceOfOctets) {
  const Message message = testing::numbered(7, 3);
  const std::string mtp = encode(message);
  const std::string bytes = in_pieces(*make(message), 1000);
  ASSERT_EQ(mtp.size(), 30U) << mtp;
  EXPECT_EQ(bytes.substr(0, 8), std::string("\0\1\0\2\36\0\0\0", 8));
  EXPECT_EQ(bytes.substr(8, 30), mtp);
  EXPECT_EQ(bytes.substr(38), std::string(2, '\0'));
}

TEST_F(DdsSample, GoesAndComesInPiecesOfAnySize) {
  for (const int size : {0, 1, 3, 1000, 4096, 4097, 100'001}) {
    const Message message = testing::numbered(size, size);
    const auto sample = make(message);
    std::string whole(ddsi_serdata_size(sample.get()), '\0');
    ddsi_serdata_to_ser(sample.get(), 0, whole.size(), whole.data());
    for (const std::size_t piece : {4U, 100U, 4096U, 65'000U, 1U << 20}) {
      const std::string bytes = in_pieces(*sample, piece);
      ASSERT_EQ(bytes.substr(0, whole.size()), whole);
      for (const auto& each : {bytes, whole}) {
        auto got = must(read(*come(each, piece)));
        EXPECT_EQ(got.header, message.header);
        EXPECT_EQ(got.text(), message.text());
      }
    }
  }
}

TEST_F(DdsSample, MayHaveRowsOfNumbers) {
  Header header;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Text};
  header.width = 300;
  header.height = 400;
  Draft draft = Draft::make(header);
  for (std::size_t i = 0; i < draft.elements().size(); ++i)
    draft.elements()[i] = static_cast<std::byte>(i * 7);
  const Message message = std::move(draft).finish();
  auto got = must(read(*come(in_pieces(*make(message), 1000), 1000)));
  EXPECT_EQ(got.text(), message.text());
}

TEST_F(DdsSample, HasElementsThatAreAlignedAndStayWhereTheyAre) {
  Header header;
  header.info = {MatrixType::Table, 1, Scalar::F64, Encoding::Binary};
  header.width = 1000;
  header.height = 10;
  for (const std::int64_t seq : {1, 12, 123, 1234, 12345}) {
    header.seq = seq;
    const Message message = Draft::make(header).finish();
    const std::string bytes = in_pieces(*make(message), 65'000);
    for (const std::size_t piece :
         {4U, 65'000U}) {  // 4 bytes do not show the end of the header line
      const auto sample = come(bytes, piece);
      auto got = must(read(*sample));
      EXPECT_TRUE(got.view<double>());
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(got.elements.data()) % alignof(double), 0U);
    }
  }
}

TEST_F(DdsSample, WithoutOctetsIsTheEndOfItsWriter) {
  EXPECT_EQ(octets_of(*come(in_pieces(*make_end(*type_), 100))), 0U);
  EXPECT_GT(octets_of(*come(in_pieces(*make(testing::numbered(0, 0)), 100))), 0U);
}

TEST_F(DdsSample, MayHaveSeveralMessages) {
  const std::string rows = "1 1 0 0 8 0 40100 0 0 2 2\n1 2\n3 4\n";
  Header header;
  header.info = {MatrixType::Table, 1, Scalar::F64, Encoding::Binary};
  header.width = 3;
  header.height = 1;
  std::vector<Message> sent;
  for (int i = 0; i < 20; ++i) sent.push_back(testing::numbered(i, i));
  sent.push_back(Draft::make(header).finish());
  Message table;
  ASSERT_TRUE(decode(std::as_bytes(std::span(rows)), table));
  sent.push_back(table.keep());
  for (int i = 0; i < 3; ++i) sent.push_back(testing::numbered(i, 3 * i));
  const auto joined = make(sent[0]);
  for (std::size_t i = 1; i < sent.size(); ++i) ASSERT_TRUE(add(*joined, sent[i]));
  for (const std::size_t piece : {4U, 1000U}) {
    const auto got = read_all(*come(in_pieces(*joined, piece), piece));
    ASSERT_EQ(got.size(), sent.size());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      const std::string mtp = encode(sent[i]);
      EXPECT_EQ(encode(got[i]), mtp);
      EXPECT_EQ(got[i].byte, begin + mtp.find('\n') + 1);
      begin += mtp.size();
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(got[i].elements.data()) %
                    size_of(got[i].header.info.scalar),
                0U);
    }
  }
}

TEST_F(DdsSample, GrowsByWhatIsSmall) {
  const Message kept = testing::numbered(1, 4097);
  const auto small = make(testing::numbered(0, 4000)), large = make(kept);
  EXPECT_FALSE(add(*small, kept));
  EXPECT_FALSE(add(*large, testing::numbered(0, 4000)));
  int count = 0;
  while (add(*small, testing::numbered(count, 4000))) ++count;
  EXPECT_EQ(count, 3);  // kMaxJoined
  EXPECT_EQ(read_all(*come(in_pieces(*small, 1000))).size(), 4U);
}

TEST_F(DdsSample, HasMessagesOfABoundedNumber) {
  const std::string message = encode(testing::numbered(0, 0));
  std::string octets;
  for (int i = 0; i < 10'001; ++i) octets += message;
  EXPECT_EQ(refusal(octets.substr(message.size()), 10'000), "");
  EXPECT_EQ(refusal(octets, 10'000), "TooLarge: more than 10000 messages in a sample");
}

TEST_F(DdsSample, ThatIsNoMessageIsRefused) {
  const std::string message = encode(testing::numbered(7, 3));
  EXPECT_EQ(refusal(message, 1), "");
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\n"),
            "Malformed: R5 version: \"GET\" is not an integer, at byte 0");
  EXPECT_EQ(refusal(message + message, 2), "");
  EXPECT_EQ(refusal(message + "GET / HTTP/1.1\r\n", 1),
            "Malformed: R5 version: \"GET\" is not an integer, at byte 30");
  for (std::size_t size = 1; size < message.size(); ++size)
    for (const std::size_t count : {0U, 1U})
      EXPECT_EQ(refusal(message.substr(0, count * message.size()) + message.substr(0, size), count),
                "Truncated: the sample ends inside a message")
          << size;
  const std::string rows = "1 1 0 0 8 0 40100 0 0 2 2\n1 2\n3 4\n";
  EXPECT_EQ(refusal(rows, 1), "");
  EXPECT_EQ(refusal(rows + rows, 2), "");
  EXPECT_EQ(refusal(rows + "5 6\n", 1),
            "Unsupported: R6 version: this reader supports version 1, not 5, at byte 34");
  EXPECT_EQ(refusal(rows.substr(0, rows.size() - 4)),
            "Truncated: the sample ends inside a message");
  EXPECT_EQ(refusal(rows + rows.substr(0, rows.size() - 2) + "x\n", 1),
            "Malformed: R27 elements: \"x\" is not a number of u8, at byte 66");
  EXPECT_EQ(refusal_of(in_pieces(*make(testing::numbered(7, 30)), 100), 0, {20}),
            "TooLarge: R24 width: 30 x 1 x 1 bytes exceed the limit of 20, at byte 22");
}

TEST_F(DdsSample, ThatIsNoSequenceIsRefused) {
  const auto bytes = [](const auto& text) { return std::string(text, sizeof text - 1); };
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0")), "Malformed: not a sequence of octets: too short");
  EXPECT_EQ(refusal_of(bytes("\0\3\0\0\0\0\0\0")),
            "Malformed: not a sequence of octets: not in CDR");
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0\5\0\0\0abcd")),
            "Malformed: not a sequence of octets: length 5, but 4 bytes");
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0\xff\xff\xff\xff")),
            "Malformed: not a sequence of octets: length 4294967295, but 0 bytes");
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0\1\0\0\0abcdefgh")),
            "Malformed: not a sequence of octets: length 1, but 8 bytes");
  // The other byte order.
  const std::string message = encode(testing::numbered(7, 3));
  EXPECT_EQ(refusal_of(bytes("\0\0\0\0\0\0\0\36") + message, 1), "");
}

}  // namespace
}  // namespace hc::dds
