#include "client_sample/library/http_reader.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <string_view>

namespace talus::client {
namespace {

using State = HttpReader::State;

TEST(HttpReader, ReadsOneAnswerAfterAnotherHoweverTheyAreCut) {
  const std::string_view first = "HTTP/1.1 200 OK\r\nContent-Length: 5\r\nTalus-Chunk: mesh\r\n\r\nhello";
  const std::string_view second = "HTTP/1.1 204 No Content\r\nTALUS-CHUNK: air\r\n\r\n";
  for (const std::size_t cut : {std::size_t{1}, std::size_t{9}, std::size_t{1000}}) {
    HttpReader reader;
    const auto feed = [&](std::string_view text) {
      State state = State::kMore;
      for (std::size_t at = 0; at < text.size(); at += cut) {
        EXPECT_EQ(state, State::kMore) << at;
        state = reader.feed(text.substr(at, cut));
      }
      return state;
    };
    for (int i = 0; i < 2; ++i) {
      ASSERT_EQ(feed(first), State::kWhole);
      const HttpAnswer answer = reader.take();
      EXPECT_EQ(answer.status, 200U);
      EXPECT_EQ(answer.fields.at("talus-chunk"), "mesh");
      EXPECT_EQ(answer.body, "hello");
      EXPECT_TRUE(reader.is_kept_open());
      ASSERT_EQ(feed(second), State::kWhole);
      EXPECT_EQ(reader.take().fields.at("talus-chunk"), "air");
    }
  }
}

TEST(HttpReader, KnowsWhenTheConnectionEndsWithAnAnswer) {
  HttpReader reader;
  const std::string_view closing = "HTTP/1.1 200 OK\r\nConnection: close\r\n\r\nrest";
  ASSERT_EQ(reader.feed(closing), State::kMore);
  ASSERT_EQ(reader.feed({}), State::kWhole);
  EXPECT_EQ(reader.take().body, "rest");
  EXPECT_FALSE(reader.is_kept_open());
}

TEST(HttpReader, PutsChunkedBodiesTogetherAndKeepsFieldsApart) {
  HttpReader reader;
  const std::string_view chunked =
      "HTTP/1.1 200 OK\r\nA: b\r\nEmpty:\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nhel\r\n2\r\nlo\r\n0\r\n\r\n";
  for (const char& c : chunked.substr(0, chunked.size() - 1)) ASSERT_EQ(reader.feed({&c, 1}), State::kMore);
  ASSERT_EQ(reader.feed(chunked.substr(chunked.size() - 1)), State::kWhole);
  const HttpAnswer answer = reader.take();
  EXPECT_EQ(answer.body, "hello");
  EXPECT_EQ(answer.fields,
            (std::map<std::string, std::string>{{"a", "b"}, {"empty", ""}, {"transfer-encoding", "chunked"}}));
}

TEST(HttpReader, TellsABodyCutShort) {
  for (const std::string_view cut :
       {"HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhel",
        "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nh", "HTTP/1.1 200 OK\r\nContent-Le"}) {
    HttpReader reader;
    ASSERT_EQ(reader.feed(cut), State::kMore) << cut;
    EXPECT_EQ(reader.feed({}), State::kBroken) << cut;
  }
}

TEST(HttpReader, RefusesWhatIsNoAnswerOrNobodyAskedFor) {
  for (const std::string_view bad :
       {"SSH-2.0\r\n", "HTTP/1.1 abc\r\n\r\n", "HTTP/1.1 204 No Content\r\n\r\nHTTP/1.1 200 OK\r\n\r\n"}) {
    HttpReader reader;
    EXPECT_EQ(reader.feed(bad), State::kBroken) << bad;
  }
  HttpReader reader;
  EXPECT_EQ(reader.feed({}), State::kMore) << "an end before an answer is the owner's to judge";
}

TEST(HttpReader, BoundsFieldsAndBody) {
  HttpReader fields;
  EXPECT_EQ(fields.feed("HTTP/1.1 200 OK\r\nA: " + std::string(70'000, 'x')), State::kTooLarge);
  HttpReader body;
  ASSERT_EQ(body.feed(std::string_view("HTTP/1.1 200 OK\r\nContent-Length: 9999999999\r\n\r\n")), State::kMore);
  const std::string part(1 << 20, 'x');
  for (int i = 0; i < 4; ++i) ASSERT_EQ(body.feed(part), State::kMore);
  EXPECT_EQ(body.feed(part), State::kTooLarge);
}

}  // namespace
}  // namespace talus::client
