// The composition root: what is made, in which order, and how it ends.
#pragma once

#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/app/settings.hpp"
#include "server/net/server.hpp"
#include "server/observe/metrics.hpp"

namespace talus::server {

class Server {
 public:
  /// Loads worlds and viewer, makes the pool, listens, runs. `on_signal` is called on a network thread for every
  /// signal. The error is for the operator, whole sentences, one a line.
  static std::expected<std::unique_ptr<Server>, std::string> start(
      const Settings& settings, std::function<void(Signal)> on_signal = [](Signal) {});
  /// Stops at once, unless `stop` was called.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// One line of JSON for whoever started the process: addresses as bound, worlds.
  const std::string& ready_line() const;
  /// Addresses as bound; empty when off.
  const std::string& http_address() const;
  const std::string& tcp_address() const;
  const std::string& admin_address() const;
  const Metrics& metrics() const;

  /// Takes over what may change while the server runs, for connections to come, and says so in the log. On an error
  /// everything stays as it was. On the thread that stops the server.
  std::expected<void, std::string> reload(const Settings& settings);
  /// Counts and logs that settings were not taken over.
  void refuse_reload(std::string_view why);
  /// Refuses the new, lets the old end within `drain_s`, then ends it. Returns when all threads have ended, but for
  /// those of hung jobs.
  void stop();
  /// Whether a job was given up and still runs. The process must then not end normally: the job would see what it uses
  /// destroyed.
  bool has_hung_job() const;

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace talus::server
