#include "server/net/pool_answers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "server/observe/log.hpp"
#include "tests/support/gate.hpp"

namespace talus::server {
namespace {

constexpr ClientId kAsker = 7;

/// Nothing here asks for a chunk.
class NoBuilder final : public ChunkBuilder {
 public:
  std::optional<ChunkPayload> build(const PayloadName& /*name*/, std::size_t, const CancelToken&) override {
    return std::nullopt;
  }
};

/// The questions of one connection to a pool of one thread that gives up what does not end; the connection's thread is
/// the test's.
class PoolQuestions : public testing::Test {
 protected:
  PoolQuestions() {
    set_log_level(LogLevel::kOff);
    worlds.push_back(std::make_unique<const World>(Manifest{}));
    connection = std::make_shared<PoolAnswers>(net, loop.get_executor());
    connection->belong_to(connection);
  }
  ~PoolQuestions() override {
    gate.open();
    wait_for_the_hung();
    set_log_level(LogLevel::kInfo);
  }

  void wait_for_the_hung() const {
    while (pool.hanging() != 0) std::this_thread::yield();
  }
  HttpAnswer ask(PoolAnswers::Question question) {
    std::optional<HttpAnswer> out;
    asio::co_spawn(loop, connection->ask(0, kAsker, std::move(question)),
                   [&](const std::exception_ptr& fault, HttpAnswer answer) {
                     EXPECT_EQ(fault, nullptr);
                     out = std::move(answer);
                   });
    loop.restart();
    while (!out) loop.run_one();
    return std::move(*out);
  }
  /// One that comes back when the gate opens.
  PoolAnswers::Question hung() {
    return [this](const World& /*world*/) {
      gate.wait();
      came_back = true;
      return json_answer("late");
    };
  }
  static PoolAnswers::Question name() {
    return [](const World& world) { return json_answer(world.name()); };
  }

  test::Gate gate;
  std::atomic<bool> came_back = false;
  SystemClock clock;
  Metrics metrics;
  Worlds worlds;
  StaticFiles files;
  MemoryCache cache{1 << 20};
  StoredChunks stored{worlds};
  NoBuilder builder;
  JobPool pool{{.threads = 1, .job_s = 0.2, .spares = 2}};
  ChunkService chunks{cache, stored, pool, builder, clock, metrics};
  NetContext net{worlds, files, clock, chunks, pool, metrics, "[]", PolicySlot(std::make_shared<const NetPolicy>()),
                 {},     {},    {},    {},     {},   {},      {},   {}};
  asio::io_context loop{1};
  std::shared_ptr<PoolAnswers> connection;
};

TEST_F(PoolQuestions, AreAnsweredFromTheirWorld) {
  const HttpAnswer answer = ask(name());
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.text, "default");
}

TEST_F(PoolQuestions, ThatThrowAreFaultsAndCostNothing) {
  const HttpAnswer answer = ask([](const World& /*world*/) -> HttpAnswer { throw std::runtime_error("broken"); });
  EXPECT_EQ(answer.status, 503);
  EXPECT_TRUE(answer.is_fault);
  EXPECT_NE(answer.text.find("query_failed"), std::string::npos) << answer.text;
  EXPECT_EQ(ask(name()).status, 200);
}

TEST_F(PoolQuestions, ThatHangAreGivenUpAndTheNextIsAnsweredByANewThread) {
  const HttpAnswer answer = ask(hung());
  EXPECT_EQ(answer.status, 503);
  EXPECT_TRUE(answer.is_fault) << "the operator has to hear of it";
  EXPECT_GT(answer.retry_after_s, 0);
  EXPECT_NE(answer.text.find("query_failed"), std::string::npos) << answer.text;
  EXPECT_EQ(pool.hung(), 1U);
  EXPECT_FALSE(came_back);
  EXPECT_EQ(ask(name()).text, "default");
  EXPECT_EQ(pool.threads(), 1U);

  // It comes back after all, too late for anybody.
  gate.open();
  wait_for_the_hung();
  EXPECT_TRUE(came_back);
  EXPECT_EQ(ask(name()).text, "default") << "and not the late answer of another question";
}

TEST_F(PoolQuestions, ThatHangKeepNeitherTheirConnectionNorTheEndOfTheServer) {
  EXPECT_EQ(ask(hung()).status, 503);
  const std::weak_ptr<PoolAnswers> seen = connection;
  connection.reset();
  EXPECT_TRUE(seen.expired()) << "a job that may never end holds what the server waits for when it ends";
  pool.stop();
  EXPECT_EQ(pool.hanging(), 1U) << "it was waited for";
  gate.open();
  wait_for_the_hung();
  loop.restart();
  EXPECT_EQ(loop.poll(), 0U) << "it has told a connection that is gone";
}

}  // namespace
}  // namespace talus::server
