// Whose pages, whose word and whose pace: the small rules of a policy.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "server/net/allowed_origins.hpp"
#include "server/net/net_policy.hpp"
#include "server/net/read_pace.hpp"
#include "server/net/trusted_proxies.hpp"

namespace talus::server {
namespace {

using Texts = std::vector<std::string>;

TEST(AllowedOrigins, AreAllUntilSomeAreNamed) {
  const auto all = *AllowedOrigins::parse(Texts{});
  EXPECT_EQ(all.allow_field("https://anybody.example"), "*");
  EXPECT_TRUE(all.admits("https://anybody.example"));
  const auto one = *AllowedOrigins::parse(Texts{"https://maps.example.org"});
  EXPECT_EQ(one.allow_field("https://maps.example.org"), "https://maps.example.org");
  EXPECT_TRUE(one.admits(std::nullopt)) << "no page";
  for (const char* other : {"https://maps.example.org.evil.example", "http://maps.example.org", "null", "",
                            "https://maps.example.org:8443", "https://maps.example.or"}) {
    EXPECT_FALSE(one.admits(other)) << other;
    EXPECT_EQ(one.allow_field(other), "") << other;
  }
}

TEST(AllowedOrigins, AreRefusedByNameWhenTheyAreNone) {
  for (const char* bad : {"", "maps.example.org", "https://", "https://a/path", "*", "https://*.example", "://a"}) {
    EXPECT_FALSE(AllowedOrigins::parse(Texts{bad}).has_value()) << bad;
  }
}

WholeAddress v4(unsigned char a, unsigned char b, unsigned char c, unsigned char d) {
  return {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, a, b, c, d};
}

WholeAddress client_behind(const TrustedProxies& proxies, const WholeAddress& peer,
                           std::initializer_list<std::string_view> forwarded) {
  HttpRequest request;
  for (const std::string_view value : forwarded) request.fields.push({"X-Forwarded-For", value});
  return proxies.client_of(peer, request);
}

TEST(TrustedProxies, HoldAddressesAndNetworks) {
  const auto proxies = *TrustedProxies::parse(Texts{"10.0.0.0/8", "192.168.1.7", "fd00::/9"});
  EXPECT_TRUE(proxies.contains(v4(10, 255, 0, 1)));
  EXPECT_FALSE(proxies.contains(v4(11, 0, 0, 1)));
  EXPECT_TRUE(proxies.contains(v4(192, 168, 1, 7)));
  EXPECT_FALSE(proxies.contains(v4(192, 168, 1, 6)));
  EXPECT_TRUE(proxies.contains({0xFD, 0x7F}));
  EXPECT_FALSE(proxies.contains({0xFD, 0x80}));
  EXPECT_FALSE(TrustedProxies{}.contains(v4(127, 0, 0, 1)));
  for (const char* bad : {"", "localhost", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/", "::1/129", "10.0.0"}) {
    EXPECT_FALSE(TrustedProxies::parse(Texts{bad}).has_value()) << bad;
  }
}

TEST(TrustedProxies, TheLastAddressThatIsNoProxyIsTheClient) {
  const auto proxies = *TrustedProxies::parse(Texts{"10.0.0.0/8"});
  const WholeAddress proxy = v4(10, 0, 0, 1);
  EXPECT_EQ(client_behind(proxies, proxy, {"1.2.3.4"}), v4(1, 2, 3, 4));
  EXPECT_EQ(client_behind(proxies, proxy, {"6.6.6.6, 1.2.3.4 , 10.9.9.9"}), v4(1, 2, 3, 4))
      << "what the client itself wrote in front proves nothing";
  EXPECT_EQ(client_behind(proxies, proxy, {"6.6.6.6", "1.2.3.4"}), v4(1, 2, 3, 4));
  EXPECT_EQ(client_behind(proxies, proxy, {"6.6.6.6, nonsense, 10.0.0.2"}), v4(10, 0, 0, 2));
  EXPECT_EQ(client_behind(proxies, proxy, {}), proxy);
  EXPECT_EQ(client_behind(proxies, proxy, {"", ",,"}), proxy);
}

TEST(ReadPace, EndsWhoTakesNothingAndWhoTakesTooLittle) {
  NetLimits limits;
  limits.write_stall_s = 10;
  limits.read_rate_min = 1024;
  const auto at = [](double s) {
    return Instant(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s)));
  };
  using Verdict = ReadPace::Verdict;

  ReadPace stalled;
  stalled.begin_wait(at(0));
  EXPECT_EQ(stalled.judge(at(9.9), limits), Verdict::kFine);
  EXPECT_EQ(stalled.judge(at(10), limits), Verdict::kStalled);

  ReadPace stalls_later;
  stalls_later.begin_wait(at(0));
  stalls_later.took(100'000, at(9));
  EXPECT_EQ(stalls_later.judge(at(10), limits), Verdict::kFine);
  EXPECT_EQ(stalls_later.judge(at(18.9), limits), Verdict::kFine);
  EXPECT_EQ(stalls_later.judge(at(19), limits), Verdict::kStalled)
      << "ten seconds after the last byte, whenever that was";

  ReadPace trickles;
  trickles.begin_wait(at(0));
  for (int s = 1; s < 10; ++s) trickles.took(1000, at(s));
  EXPECT_EQ(trickles.judge(at(10), limits), Verdict::kTooSlow);

  ReadPace trickles_after_a_burst;
  trickles_after_a_burst.begin_wait(at(0));
  trickles_after_a_burst.took(200'000, at(0.1));
  double cut_s = 0;
  for (double s = 0.05; s < 60 && cut_s == 0; s += 0.05) {
    if (std::fmod(s, 2) < 0.05) trickles_after_a_burst.took(500, at(s));
    if (trickles_after_a_burst.judge(at(s), limits) == Verdict::kTooSlow) cut_s = s;
  }
  EXPECT_GT(cut_s, 10);
  EXPECT_LT(cut_s, 12) << "neither the burst nor the trickle buys time";

  ReadPace slow_but_fair;
  slow_but_fair.begin_wait(at(0));
  for (int s = 1; s < 100; ++s) {
    slow_but_fair.took(1200, at(s));
    EXPECT_EQ(slow_but_fair.judge(at(s), limits), Verdict::kFine) << s;
  }
  slow_but_fair.end_wait();
  EXPECT_EQ(slow_but_fair.judge(at(1000), limits), Verdict::kFine) << "nothing waits for it";
}

TEST(PolicySlot, GivesTheNewestToWhoLooksAgain) {
  PolicySlot slot(std::make_shared<const NetPolicy>());
  PolicyRef known;
  std::uint64_t version = 0;
  slot.refresh(known, version);
  EXPECT_EQ(known, slot.load());
  const PolicyRef first = known;
  slot.refresh(known, version);
  EXPECT_EQ(known, first);
  slot.store(std::make_shared<const NetPolicy>());
  slot.refresh(known, version);
  EXPECT_NE(known, first);
  EXPECT_EQ(known, slot.load());
}

TEST(PolicySlot, IsReadByManyWhileItChanges) {
  PolicySlot slot(std::make_shared<const NetPolicy>());
  std::atomic<bool> is_over = false;
  std::vector<std::jthread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      PolicyRef known;
      std::uint64_t version = 0;
      while (!is_over) slot.refresh(known, version);
      slot.refresh(known, version);
      EXPECT_EQ(known, slot.load());
    });
  }
  for (int i = 0; i < 200; ++i) slot.store(std::make_shared<const NetPolicy>());
  is_over = true;
}

}  // namespace
}  // namespace talus::server
