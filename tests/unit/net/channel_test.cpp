#include "server/net/channel.hpp"

#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <array>
#include <asio/read.hpp>
#include <asio/write.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/certificate.hpp"

namespace talus::server {
namespace {

/// Two ends of one connection on loopback.
struct Ends {
  asio::io_context context{1};
  Poller poller{context};
  Metrics metrics;
  Descriptor ours;
  asio::ip::tcp::socket peer{context};

  Ends() {
    asio::ip::tcp::acceptor acceptor(context, asio::ip::tcp::endpoint(asio::ip::address_v4::loopback(), 0));
    peer.connect(acceptor.local_endpoint());
    asio::ip::tcp::socket accepted = acceptor.accept();
    accepted.non_blocking(true);
    ours = Descriptor(accepted.release());
    poller.start();
  }
  std::unique_ptr<Channel> channel(const TlsContext* tls = nullptr) {
    return std::make_unique<Channel>(poller, std::move(ours), tls, metrics);
  }
  /// Runs the thread of these ends until `task` has ended; the most that `count` grew in one turn of it.
  int run(Awaitable<void> task, const int* count = nullptr) {
    bool is_over = false;
    asio::co_spawn(context, std::move(task), [&is_over](const std::exception_ptr&) { is_over = true; });
    int most = 0;
    while (!is_over) {
      const int before = count == nullptr ? 0 : *count;
      context.run_one();
      most = std::max(most, count == nullptr ? 0 : *count - before);
    }
    return most;
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
    std::array<std::byte, 16> into{};
    const Channel::Read read = co_await channel->read_some(into);
    if (read.error) co_return;
    ++*reads;
  }
}

/// Everything up to the end, in reads of 16 bytes.
Awaitable<void> read_all(Channel* channel, std::string* out, asio::error_code* end) {
  for (;;) {
    std::array<std::byte, 16> into{};
    const Channel::Read read = co_await channel->read_some(into);
    *end = read.error;
    if (read.error) co_return;
    out->append(reinterpret_cast<const char*>(into.data()), read.bytes);
  }
}

/// Writes `left` bytes, waiting whenever the kernel is full.
Awaitable<void> write_all(Channel* channel, std::size_t left, int* waits) {
  const std::vector<char> bytes(64 * 1024, 'x');
  while (left != 0) {
    asio::error_code error;
    const std::array<asio::const_buffer, 1> buffers{asio::buffer(bytes.data(), std::min(left, bytes.size()))};
    left -= channel->write_some(buffers, error);
    if (error != asio::error::would_block) continue;
    ++*waits;
    if (co_await channel->wait_writable()) co_return;
  }
}

TEST(Channel, ReadsOnBehindWhatCameTogether) {
  // Bytes and the end make one edge, as do bytes on both sides of an urgent one, at which a read stops short.
  for (const bool is_urgent : {false, true}) {
    Ends ends;
    const auto channel = ends.channel();
    ends.peer.send(asio::buffer("before", 6));
    if (is_urgent) ends.peer.send(asio::buffer("!", 1), asio::socket_base::message_out_of_band);
    ends.peer.send(asio::buffer(" and behind", 11));
    ends.peer.shutdown(asio::socket_base::shutdown_send);
    std::string read;
    asio::error_code end;
    ends.run(read_all(channel.get(), &read, &end));
    EXPECT_EQ(read, "before and behind");
    EXPECT_EQ(end, asio::error::eof);
  }
}

TEST(Channel, ReadsWhatComesWhileItWaits) {
  Ends ends;
  const auto channel = ends.channel();
  const std::string text(100'000, 'y');
  std::thread peer([&] {
    for (std::size_t at = 0; at < text.size(); at += 1000) asio::write(ends.peer, asio::buffer(text.data() + at, 1000));
    ends.peer.shutdown(asio::socket_base::shutdown_send);
  });
  std::string read;
  asio::error_code end;
  ends.run(read_all(channel.get(), &read, &end));
  peer.join();
  EXPECT_EQ(read, text);
}

TEST(Channel, WritesOnAsItsPeerReads) {
  Ends ends;
  const auto channel = ends.channel();
  constexpr std::size_t kBytes = 32 << 20;
  int waits = 0;
  std::size_t got = 0;
  std::thread peer([&] {
    std::vector<char> into(kBytes);
    got = asio::read(ends.peer, asio::buffer(into));
  });
  ends.run(write_all(channel.get(), kBytes, &waits));
  peer.join();
  EXPECT_EQ(got, kBytes);
  EXPECT_GT(waits, 0) << "more than the kernel holds";
}

TEST(Channel, EndsWhatIsAwaitedWhenItIsClosed) {
  Ends ends;
  const auto channel = ends.channel();
  std::string read;
  asio::error_code end;
  asio::post(ends.context, [&] { channel->close(); });
  ends.run(read_all(channel.get(), &read, &end));
  EXPECT_TRUE(end) << "and not the peer's end";
  EXPECT_NE(end, asio::error::eof);
}

TEST(Channel, TellsAReaderOnlyWhenThereIsSomethingToRead) {
  struct Counter final : Channel::Reader {
    int times = 0;
    void readable() noexcept override { ++times; }
  } counter;
  Ends ends;
  const auto channel = ends.channel();
  channel->tell(&counter);
  std::array<std::byte, 16> into{};
  while (ends.context.poll_one() != 0) {
  }
  EXPECT_EQ(counter.times, 0) << "it can be written to";
  EXPECT_EQ(channel->read_now(into).error, asio::error::would_block);
  for (int i = 1; i <= 3; ++i) {
    ends.peer.send(asio::buffer("some", 4));
    while (counter.times < i) ends.context.run_one();
    EXPECT_EQ(channel->read_now(into).bytes, 4U);
    EXPECT_EQ(channel->read_now(into).error, asio::error::would_block);
  }
}

TEST(Channel, LetsOthersOfItsThreadHaveTheirTurnWhileAPeerNeverStopsSending) {
  const auto files = test::make_certificate(testing::TempDir() + "channel_test_certificate_of_a_server");
  const auto tls = TlsContext::load(files.certificate, files.key);
  ASSERT_TRUE(tls.has_value()) << tls.error();
  Ends ends;
  const auto channel = ends.channel(tls->get());
  constexpr int kRecords = 200;
  std::thread peer(send_records, ends.peer.native_handle(), kRecords);
  int reads = 0;
  ends.run(read_times(channel.get(), 1, &reads));
  ASSERT_EQ(reads, 1);
  peer.join();  // everything has come
  EXPECT_LE(ends.run(read_times(channel.get(), kRecords - 1, &reads), &reads), 16)
      << "reads without a turn of anybody else";
  EXPECT_EQ(reads, kRecords);
}

TEST(Channel, KnowsThatItsPeerHasGoneWhateverItSaidBefore) {
  Ends ends;
  const auto channel = ends.channel();
  EXPECT_FALSE(channel->is_peer_gone());
  ends.peer.write_some(asio::buffer("more", 4));
  EXPECT_FALSE(channel->is_peer_gone());
  ends.peer.shutdown(asio::socket_base::shutdown_send);
  EXPECT_TRUE(channel->is_peer_gone()) << "though there are bytes to read";
  channel->close();
  EXPECT_TRUE(channel->is_peer_gone());
}

TEST(Channel, CountsAHandshakeThatWasGivenUpAsFailed) {
  const auto files = test::make_certificate(testing::TempDir() + "channel_test_certificate_of_a_server");
  const auto tls = TlsContext::load(files.certificate, files.key);
  ASSERT_TRUE(tls.has_value()) << tls.error();
  for (const bool is_reset : {false, true}) {
    Ends ends;
    const auto channel = ends.channel(tls->get());
    is_reset ? channel->reset() : channel->close();
    EXPECT_EQ(ends.metrics.value(Count::kTlsFailed), 1U);
    EXPECT_EQ(ends.metrics.value(Count::kTlsEstablished), 0U);
  }
}

}  // namespace
}  // namespace talus::server
