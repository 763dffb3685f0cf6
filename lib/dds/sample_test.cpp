// SPDX-License-Identifier: Apache-2.0
// Samples, without a network: to bytes in pieces of any size, and back.
#include <dds/sample.h>

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include <hc/testing/link_conformance.h>

namespace hc::dds {
namespace {

class DdsSample : public ::testing::Test {
 protected:
  ~DdsSample() override { ddsi_sertype_unref(type_); }

  Sample make(const Message& message) {
    return make_sample(*type_, encoder_.encode(message), message);
  }

  /// All bytes of a sample, in words, as they go over the network in pieces.
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

  /// What is wrong with a sample of these octets.
  std::string refusal(const std::string& octets) {
    const Pieces pieces = {std::as_bytes(std::span(octets)), {}, {}};
    return refusal_of(in_pieces(*make_sample(*type_, pieces, {}), octets.size() + 20));
  }
  std::string refusal_of(const std::string& bytes, const Limits& limits = {}) {
    auto read = read_message(*come(bytes), limits, memo_);
    return read ? "" : read.error().text();
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
    for (const std::size_t piece : {4, 100, 4096, 65'000, 1 << 20}) {
      const std::string bytes = in_pieces(*sample, piece);
      ASSERT_EQ(bytes.substr(0, whole.size()), whole);
      for (const auto& each : {bytes, whole}) {
        auto read = read_message(*come(each, piece), {}, memo_);
        ASSERT_TRUE(read) << read.error().text();
        EXPECT_EQ(read->header, message.header);
        EXPECT_EQ(read->characters(), message.characters());
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
  auto read = read_message(*come(in_pieces(*make(message), 1000), 1000), {}, memo_);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->characters(), message.characters());
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
    for (const std::size_t piece : {4, 65'000}) {  // of 4 bytes the header's line is not known
      const auto sample = come(bytes, piece);
      auto read = read_message(*sample, {}, memo_);
      ASSERT_TRUE(read) << read.error().text();
      EXPECT_TRUE(read->view<double>());
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(read->elements.data()) % alignof(double), 0U);
    }
  }
}

TEST_F(DdsSample, WithoutOctetsIsTheEndOfItsWriter) {
  EXPECT_EQ(octets_of(*come(in_pieces(*make_end(*type_), 100))), 0U);
  EXPECT_GT(octets_of(*come(in_pieces(*make(testing::numbered(0, 0)), 100))), 0U);
}

TEST_F(DdsSample, ThatIsNoMessageIsRefused) {
  const std::string message = encode(testing::numbered(7, 3));
  EXPECT_EQ(refusal(message), "");
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\n"),
            "Malformed: R5 version: \"GET\" is not an integer, at byte 0");
  EXPECT_EQ(refusal(message + message), "Malformed: its message is followed by more");
  for (std::size_t size = 1; size < message.size(); ++size)
    EXPECT_EQ(refusal(message.substr(0, size)), "Truncated: it ends inside its message") << size;
  const std::string rows = "1 1 0 0 8 0 40100 0 0 2 2\n1 2\n3 4\n";
  EXPECT_EQ(refusal(rows), "");
  EXPECT_EQ(refusal(rows + "5 6\n"), "Malformed: its message is followed by more");
  EXPECT_EQ(refusal(rows.substr(0, rows.size() - 4)), "Truncated: it ends inside its message");
  EXPECT_EQ(refusal_of(in_pieces(*make(testing::numbered(7, 30)), 100), {20}),
            "TooLarge: R24 width: 30 x 1 x 1 bytes are over the limit of 20, at byte 22");
}

TEST_F(DdsSample, ThatIsNoSequenceIsRefused) {
  const auto bytes = [](const auto& text) { return std::string(text, sizeof text - 1); };
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0")),
            "Malformed: it is no sequence of octets: it has no bytes");
  EXPECT_EQ(refusal_of(bytes("\0\3\0\0\0\0\0\0")),
            "Malformed: it is no sequence of octets: it is not in CDR");
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0\5\0\0\0abcd")),
            "Malformed: it is no sequence of octets: it says 5 and has 4");
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0\xff\xff\xff\xff")),
            "Malformed: it is no sequence of octets: it says 4294967295 and has 0");
  EXPECT_EQ(refusal_of(bytes("\0\1\0\0\1\0\0\0abcdefgh")),
            "Malformed: it is no sequence of octets: it says 1 and has 8");
  // The other byte order.
  const std::string message = encode(testing::numbered(7, 3));
  EXPECT_EQ(refusal_of(bytes("\0\0\0\0\0\0\0\36") + message), "");
}

}  // namespace
}  // namespace hc::dds
