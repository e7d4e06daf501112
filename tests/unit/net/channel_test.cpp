#include "server/net/channel.hpp"

#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <array>
#include <thread>

#include "tests/support/certificate.hpp"

namespace talus::server {
namespace {

/// Two ends of one connection on loopback.
struct Ends {
  asio::io_context context{1};
  Socket ours{context.get_executor()};
  Socket peer{context.get_executor()};

  Ends() {
    Acceptor acceptor(context.get_executor(), asio::ip::tcp::endpoint(asio::ip::address_v4::loopback(), 0));
    peer.connect(acceptor.local_endpoint());
    acceptor.accept(ours);
  }
};

/// A peer that trusts everybody, on a thread of its own: shakes hands, then sends `records` of one byte each.
void send_records(int descriptor, int records) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
  const std::unique_ptr<SSL, decltype(&SSL_free)> ssl(SSL_new(context.get()), &SSL_free);
  SSL_set_fd(ssl.get(), descriptor);
  ASSERT_EQ(SSL_connect(ssl.get()), 1);
  for (int i = 0; i < records; ++i) ASSERT_EQ(SSL_write(ssl.get(), "x", 1), 1);
}

Awaitable<void> read_times(Channel* channel, int times, int* reads) {
  for (int i = 0; i < times; ++i) {
    std::array<char, 16> into{};
    const Channel::Read read = co_await channel->read_some(asio::buffer(into));
    if (read.error) co_return;
    ++*reads;
  }
}

TEST(Channel, LetsOthersOfItsThreadHaveTheirTurnWhileAPeerNeverStopsSending) {
  const auto files = test::make_certificate(testing::TempDir() + "channel_test_certificate_of_a_server");
  const auto tls = TlsContext::load(files.certificate, files.key);
  ASSERT_TRUE(tls.has_value()) << tls.error();
  Metrics metrics;
  Ends ends;
  ends.ours.non_blocking(true);
  Channel channel(std::move(ends.ours), tls->get(), metrics);
  constexpr int kRecords = 200;
  std::thread peer(send_records, ends.peer.native_handle(), kRecords);
  int reads = 0;
  asio::co_spawn(ends.context, read_times(&channel, 1, &reads), [](const std::exception_ptr&) {});
  ends.context.run();
  ASSERT_EQ(reads, 1);
  peer.join();  // everything has come

  ends.context.restart();
  asio::co_spawn(ends.context, read_times(&channel, kRecords - 1, &reads), [](const std::exception_ptr&) {});
  int most = 0;
  for (int before = reads; ends.context.run_one() != 0; before = reads) most = std::max(most, reads - before);
  EXPECT_EQ(reads, kRecords);
  EXPECT_LE(most, 16) << "reads without a turn of anybody else";
}

TEST(Channel, KnowsThatItsPeerHasGoneWhateverItSaidBefore) {
  Metrics metrics;
  Ends ends;
  Channel channel(std::move(ends.ours), nullptr, metrics);
  EXPECT_FALSE(channel.is_peer_gone());
  ends.peer.write_some(asio::buffer("more", 4));
  EXPECT_FALSE(channel.is_peer_gone());
  ends.peer.shutdown(Socket::shutdown_send);
  EXPECT_TRUE(channel.is_peer_gone()) << "though there are bytes to read";
  channel.close();
  EXPECT_TRUE(channel.is_peer_gone());
}

TEST(Channel, CountsAHandshakeThatWasGivenUpAsFailed) {
  const auto files = test::make_certificate(testing::TempDir() + "channel_test_certificate_of_a_server");
  const auto tls = TlsContext::load(files.certificate, files.key);
  ASSERT_TRUE(tls.has_value()) << tls.error();
  Metrics metrics;
  for (const bool is_reset : {false, true}) {
    Ends ends;
    Channel channel(std::move(ends.ours), tls->get(), metrics);
    is_reset ? channel.reset() : channel.close();
    EXPECT_EQ(metrics.value(Count::kTlsFailed), is_reset ? 2U : 1U);
    EXPECT_EQ(metrics.value(Count::kTlsEstablished), 0U);
  }
}

}  // namespace
}  // namespace talus::server
