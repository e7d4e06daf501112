// A whole server in this process, on free ports of loopback.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <thread>

#include "server/app/server.hpp"
#include "tests/support/rounds.hpp"

namespace talus::server {

inline Settings quiet_settings() {
  Settings settings;
  settings.listen = settings.tcp_listen = settings.admin_listen = "127.0.0.1:0";
  settings.threads = 2;
  settings.net_threads = 2;
  settings.cache_mib = 64;
  settings.log_level = "off";
  settings.pool_nice = 0;  // other tests would go first
  if (test::kIsSanitized) settings.job_s = settings.limits.wait_s = 200;
  return settings;
}

class RunningServer {
 public:
  explicit RunningServer(const Settings& settings = quiet_settings()) {
    auto started = Server::start(settings);
    EXPECT_TRUE(started.has_value()) << started.error();
    if (started) server_ = std::move(*started);
  }
  Server* operator->() { return server_.get(); }
  std::uint64_t count(Count count) const { return server_->metrics().value(count); }

 private:
  std::unique_ptr<Server> server_;
};

/// Waits up to a minute for what another thread brings about.
inline bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 6000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return holds();
}

}  // namespace talus::server
