// Deadlines of all connections of one thread, tested by one slow clock instead of a timer each.
//
// Setting a deadline is then a store, which a request can afford; a limit is kept to one sweep's time, 50 ms.
// Owner: the thread of its io_context.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/net/socket.hpp"
#include "server/schedule/clock.hpp"

namespace talus::server {

class Sweeper;

/// Something with deadlines. It is a member of its sweeper from construction to destruction, both on the sweeper's
/// thread.
class Swept {
 public:
  explicit Swept(Sweeper& sweeper);
  virtual ~Swept();
  Swept(const Swept&) = delete;
  Swept& operator=(const Swept&) = delete;

  virtual void sweep(Instant now) = 0;
  /// The server is stopping: finish what is being answered and end.
  virtual void drain() = 0;
  /// The time to finish is over: end now.
  virtual void abort() = 0;

 protected:
  Sweeper& sweeper() const { return sweeper_; }

 private:
  friend class Sweeper;
  Sweeper& sweeper_;
  std::size_t place_ = 0;
};

class Sweeper {
 public:
  Sweeper(asio::io_context& context, const Clock& clock);

  Awaitable<void> run();
  void stop() { timer_.cancel(), is_stopped_ = true; }
  void drain();
  void abort();

  /// For the Date field; renewed by the sweep.
  const std::string& http_date() const { return http_date_; }
  /// Of the last sweep: late by one at most, and free. Deadlines are no finer.
  Instant coarse_now() const { return now_; }
  std::int64_t unix_seconds() const { return date_seconds_; }

 private:
  friend class Swept;
  template <typename Visit>
  void each(Visit visit);
  void renew_date();

  const Clock& clock_;
  Timer timer_;
  std::vector<Swept*> members_;
  std::string http_date_;
  std::int64_t date_seconds_ = -1;
  Instant now_{};
  bool is_stopped_ = false;
};

}  // namespace talus::server
