// The doors of a server whose chunks are the test's own, in this process, on free ports of loopback.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "server/app/world_files.hpp"
#include "server/net/server.hpp"

namespace talus::server {

class MadeUpServer {
 public:
  /// `builder` must outlive the server and must have come back from everything when the server ends.
  MadeUpServer(ChunkBuilder& builder, double job_s)
      : pool({.threads = 1, .job_s = job_s, .spares = 2}),
        chunks(cache, stored, pool, builder, clock, metrics),
        net{worlds, files, clock, chunks, pool, metrics, "[]", PolicySlot(std::make_shared<const NetPolicy>()),
            {},     {},    {},    {},     {},   {},      {},   {}},
        network(net, 1) {
    http_address = listen(Listen::kHttp);
    tcp_address = listen(Listen::kTcp);
    network.start([](Signal) {});
  }
  ~MadeUpServer() {
    network.stop(0);
    while (pool.hanging() != 0) std::this_thread::yield();
    pool.stop();
  }
  MadeUpServer(const MadeUpServer&) = delete;
  MadeUpServer& operator=(const MadeUpServer&) = delete;

  std::uint64_t count(Count count) const { return metrics.value(count); }

  std::string http_address;
  std::string tcp_address;

 private:
  std::string listen(Listen kind) {
    auto bound = network.listen(kind, {"127.0.0.1", 0}, false);
    EXPECT_TRUE(bound.has_value()) << bound.error();
    return bound.value_or("");
  }

  SystemClock clock;
  Metrics metrics;
  Worlds worlds = *load_worlds({});
  StaticFiles files;
  MemoryCache cache{1 << 20};
  StoredChunks stored{worlds};

 public:
  JobPool pool;

 private:
  ChunkService chunks;
  NetContext net;
  NetServer network;
};

}  // namespace talus::server
