// TLS of accepted connections: a certificate, and sessions that speak straight over a non-blocking descriptor.
//
// OpenSSL reads and writes the socket itself and says what it waits for, just as a plain socket does; Channel awaits
// that. No copy lies in between (asio::ssl::stream keeps 34 KiB a connection for one) and an idle session gives its
// buffers back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <span>
#include <string>

struct ssl_st;
struct ssl_ctx_st;

namespace talus::server {

enum class TlsWant : std::uint8_t { kNothing, kReadable, kWritable };

struct TlsProgress {
  std::size_t bytes = 0;
  TlsWant want = TlsWant::kNothing;  ///< what the socket must be before the same call is made again
  bool is_over = false;              ///< the peer has said goodbye, or broke TLS
};

/// One connection. Owner: its thread.
class TlsSession {
 public:
  /// Takes `of`. The descriptor outlives the session.
  TlsSession(ssl_st* of, int descriptor) : ssl_(of), descriptor_(descriptor) {}
  TlsSession(const TlsSession&) = delete;  // OpenSSL holds the address of descriptor_
  TlsSession& operator=(const TlsSession&) = delete;

  TlsProgress read(std::span<std::byte> into);
  /// A call that wanted something must be made again with bytes that begin with the same ones.
  TlsProgress write(std::span<const std::byte> bytes);
  /// Tells the peer that nothing more comes, if the socket takes it at once.
  void say_goodbye();
  bool is_established() const;

 private:
  struct Free {
    void operator()(ssl_st* ssl) const;
  };
  TlsProgress progress(int result, std::size_t bytes);

  friend class TlsContext;

  std::unique_ptr<ssl_st, Free> ssl_;
  int descriptor_;
  bool is_broken_ = false;
};

/// A certificate with its key; immutable, and outlived by the sessions it has made. Any thread.
class TlsContext {
 public:
  /// PEM files: the chain, leaf first, and the unencrypted key. The error names the file and says what is wrong.
  static std::expected<std::shared_ptr<const TlsContext>, std::string> load(const std::string& certificate_file,
                                                                            const std::string& key_file);

  /// A session on a connected descriptor that outlives it. Nothing is sent or read yet.
  std::unique_ptr<TlsSession> accept(int descriptor) const;
  /// When the certificate ends, seconds since 1970.
  std::int64_t expires_unix_s() const { return expires_unix_s_; }

 private:
  struct Free {
    void operator()(ssl_ctx_st* context) const;
  };
  TlsContext() = default;

  std::unique_ptr<ssl_ctx_st, Free> context_;
  std::int64_t expires_unix_s_ = 0;
};

}  // namespace talus::server
