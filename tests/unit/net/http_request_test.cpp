#include "server/net/http_request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>

#include "server/net/request_id.hpp"

namespace talus::server {
namespace {

const NetLimits kLimits;

std::expected<HttpRequest, HttpFault> read(std::string_view text) {
  HeadScanner scanner(kLimits);
  const auto length = scanner.scan(text);
  if (!length) return std::unexpected(length.error());
  if (!*length) return std::unexpected(HttpFault{0, "incomplete", ""});
  return parse_head(text.substr(0, **length), kLimits);
}

struct Refused {
  const char* why;
  std::string text;
  int status;
};

TEST(HttpRequest, IsRefusedWhenItCouldBeReadInTwoWays) {
  const std::string get = "GET / HTTP/1.1\r\n";
  const std::string host = "Host: a\r\n";
  const std::vector<Refused> kTable{
      {"two hosts", get + host + host + "\r\n", 400},
      {"no host", get + "\r\n", 400},
      {"length and coding", get + host + "Content-Length: 3\r\nTransfer-Encoding: chunked\r\n\r\n", 400},
      {"length and an empty coding", get + host + "Content-Length: 3\r\nTransfer-Encoding: \r\n\r\n", 400},
      {"an empty coding", get + host + "Transfer-Encoding:\r\n\r\n", 400},
      {"no version at all", "GET /v1/worlds/default\r\n\r\n", 400},
      {"two lengths", get + host + "Content-Length: 3\r\nContent-Length: 3\r\n\r\n", 400},
      {"a signed length", get + host + "Content-Length: +3\r\n\r\n", 400},
      {"a length list", get + host + "Content-Length: 3, 3\r\n\r\n", 400},
      {"a length in hexadecimal", get + host + "Content-Length: 0x3\r\n\r\n", 400},
      {"a length beyond 64 bits", get + host + "Content-Length: 99999999999999999999\r\n\r\n", 400},
      {"an empty length", get + host + "Content-Length:\r\n\r\n", 400},
      {"a large body", get + host + "Content-Length: 65537\r\n\r\n", 413},
      {"a folded line", get + host + "A: b\r\n c\r\n\r\n", 400},
      {"a first line folded", get + " Host: a\r\n\r\n", 400},
      {"a bare line feed", "GET / HTTP/1.1\nHost: a\n\n", 400},
      {"a bare line feed inside", get + "Host: a\nX: b\r\n\r\n", 400},
      {"a bare carriage return", get + "Host: a\rX: b\r\n\r\n", 400},
      {"space before a colon", get + "Host : a\r\n\r\n", 400},
      {"no name before a colon", get + host + ": b\r\n\r\n", 400},
      {"no colon", get + host + "nothing\r\n\r\n", 400},
      {"a zero byte", get + host + std::string("A: b\0c\r\n\r\n", 10), 400},
      {"version 0.9", "GET /\r\n\r\n", 400},
      {"a host in Latin", get + "Host: \xE4\r\n\r\n", 400},
      {"a list of hosts", get + "Host: a, b\r\n\r\n", 400},
      {"a host with a user", get + "Host: a@b\r\n\r\n", 400},
      {"a host with a path", get + "Host: a/b\r\n\r\n", 400},
      {"version 2.0", "GET / HTTP/2.0\r\nHost: a\r\n\r\n", 400},
      {"version 1.2", "GET / HTTP/1.2\r\nHost: a\r\n\r\n", 400},
      {"a lower-case protocol", "GET / http/1.1\r\nHost: a\r\n\r\n", 400},
      {"two spaces", "GET  / HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"an unknown method", "FETCH / HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a path without slash", "GET a HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a fragment", "GET /#a HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a fragment of a query", "GET /?a#b HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a target in Latin", "GET /\xE4 HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a tab in a target", "GET /a\tb HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"three spaces", "GET /a b HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a space at the end of the line", "GET / HTTP/1.1 \r\nHost: a\r\n\r\n", 400},
      {"a user in a target", "GET http://a@b/ HTTP/1.1\r\nHost: b\r\n\r\n", 400},
      {"a query that hides a path", "GET http://a?b/c HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a target without host", "GET http:///a HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a target of another scheme", "GET ftp://a/ HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a coding that does not end", get + host + "Transfer-Encoding: chunked, gzip\r\n\r\n", 400},
      {"a coding without chunks", get + host + "Transfer-Encoding: identity\r\n\r\n", 400},
      {"a name with a byte of no token", get + host + "A\xE4: b\r\n\r\n", 400},
      {"a star for get", "GET * HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"a TLS greeting", std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 15), 400},
      {"a long request line", "GET /" + std::string(9000, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n", 414},
      {"a long request line without end", "GET /" + std::string(9000, 'a'), 414},
      {"a large head", get + host + "A: " + std::string(17'000, 'a') + "\r\n\r\n", 431},
      {"a large head without end", get + host + "A: " + std::string(17'000, 'a'), 431},
  };
  for (const Refused& refused : kTable) {
    const auto request = read(refused.text);
    ASSERT_FALSE(request.has_value()) << refused.why;
    EXPECT_EQ(request.error().status, refused.status) << refused.why << ": " << request.error().message;
  }
}

TEST(HttpRequest, SaysWhatIsWrongWithIt) {
  const auto why = [](const std::string& line, const std::string& fields) {
    const auto request = read(line + "\r\nHost: a\r\n" + fields + "\r\n");
    return request ? std::string("nothing") : std::string(request.error().message);
  };
  const std::string get = "GET / HTTP/1.1";
  const auto names = [](const char* word) { return testing::HasSubstr(word); };
  EXPECT_THAT(why(get, ""), names("nothing"));
  EXPECT_THAT(why("GET / HTTP/2.0", ""), names("version"));
  EXPECT_THAT(why(get, "A b: c\r\n"), names("header name"));
  EXPECT_THAT(why(get, ": c\r\n"), names("header name"));
  EXPECT_THAT(why(get, "Content-Length: 3x\r\n"), names("not a whole number"));
  EXPECT_THAT(why(get, "Content-Length: 3\r\nContent-Length: 3\r\n"), names("several Content-Length"));
  EXPECT_THAT(why(get, "Content-Length: 3\r\nTransfer-Encoding: chunked\r\n"), names("beside Transfer-Encoding"));
  EXPECT_THAT(why(get, "Transfer-Encoding: gzip\r\n"), names("end in chunked"));
  EXPECT_THAT(why("FETCH / HTTP/1.1", ""), names("not an HTTP/1.1 request"));
}

TEST(HttpRequest, IsRefusedWithMoreThan64Fields) {
  std::string text = "GET / HTTP/1.1\r\nHost: a\r\n";
  for (int i = 0; i < 63; ++i) text += "A: b\r\n";
  EXPECT_TRUE(read(text + "\r\n").has_value());
  const auto refused = read(text + "A: b\r\n\r\n");
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().status, 431);
}

TEST(HttpRequest, IsFoundByteForByteAsInOnePiece) {
  const std::string text = "GET /a?b=c HTTP/1.1\r\nHost: a\r\nIf-None-Match:  \"x\" \r\n\r\nGET /next";
  HeadScanner scanner(kLimits);
  std::size_t end = 0;
  for (std::size_t size = 0; size <= text.size() && end == 0; ++size) {
    const auto length = scanner.scan(std::string_view(text).substr(0, size));
    ASSERT_TRUE(length.has_value());
    if (*length) end = **length;
  }
  EXPECT_EQ(end, text.find("GET /next"));
  const auto request = parse_head(std::string_view(text).substr(0, end), kLimits);
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->path, "/a");
  EXPECT_EQ(request->query, "b=c");
  EXPECT_EQ(request->field("IF-NONE-MATCH"), "\"x\"");
  EXPECT_TRUE(request->is_keep_alive);
  EXPECT_FALSE(request->has_body);
}

TEST(HttpRequest, KnowsWhenTheConnectionGoesOn) {
  const auto keeps = [](std::string_view text) { return read(text)->is_keep_alive; };
  EXPECT_TRUE(keeps("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
  EXPECT_FALSE(keeps("GET / HTTP/1.1\r\nHost: a\r\nConnection: x, Close\r\n\r\n"));
  EXPECT_FALSE(keeps("GET / HTTP/1.0\r\n\r\n"));
  EXPECT_TRUE(keeps("GET / HTTP/1.0\r\nConnection: Keep-Alive\r\n\r\n"));
}

TEST(HttpRequest, TakesTheAbsoluteFormOfATarget) {
  EXPECT_EQ(read("GET http://a.example:80/b?c HTTP/1.1\r\nHost: a\r\n\r\n")->path, "/b");
}

TEST(HttpRequest, EndsItsHeadBeforeABodyEvenForAnUpgrade) {
  const auto request = read("POST /x HTTP/1.1\r\nHost: a\r\nContent-Length: 4\r\n\r\nbody");
  ASSERT_TRUE(request.has_value());
  EXPECT_TRUE(request->has_body);
  EXPECT_TRUE(read("GET /x HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n\x82").has_value());
}

TEST(RequestIds, AreThePeersWhereTheyAreFitAndElseMade) {
  RequestIds ids(7, Instant(std::chrono::seconds(5)));
  EXPECT_EQ(ids.of("4bf92f35-77b3.a:b_c+d/e=1"), "4bf92f35-77b3.a:b_c+d/e=1");
  EXPECT_EQ(ids.of(std::string(64, 'x')), std::string(64, 'x'));
  std::set<std::string> made;
  for (const std::string& unfit : {std::string(), std::string(65, 'x'), std::string("a b"), std::string("a\"b"),
                                   std::string("a\\b"), std::string("a\tb"), std::string("\xC3\xA9")}) {
    const std::string id(ids.of(unfit));
    EXPECT_EQ(id.size(), 16U) << unfit;
    EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos);
    made.insert(id);
  }
  made.emplace(ids.of(std::nullopt));
  made.emplace(RequestIds(8, Instant(std::chrono::seconds(5))).next());
  made.emplace(RequestIds(7, Instant(std::chrono::seconds(6))).next());
  EXPECT_EQ(made.size(), 10U) << "no two are alike";
}

}  // namespace
}  // namespace talus::server
