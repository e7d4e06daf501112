#include "server/net/tls.hpp"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <new>
#include <span>
#include <string_view>

#include "server/net/socket.hpp"

namespace talus::server {

namespace {

// A BIO over a descriptor. OpenSSL's own uses write(2), which raises SIGPIPE when the peer has gone.

int descriptor_of(BIO* bio) {
  return *static_cast<const int*>(BIO_get_data(bio));
}

bool is_worth_retrying() {
  return errno == EAGAIN || errno == EINTR;
}

int bio_write(BIO* bio, const char* data, int size) {
  BIO_clear_retry_flags(bio);
  iovec part{const_cast<char*>(data), static_cast<std::size_t>(size)};  // only read
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  const ssize_t sent = send_some(descriptor_of(bio), message);
  if (sent < 0 && is_worth_retrying()) BIO_set_retry_write(bio);
  return static_cast<int>(sent);
}

int bio_read(BIO* bio, char* data, int size) {
  BIO_clear_retry_flags(bio);
  const ssize_t got =
      receive_some(descriptor_of(bio), std::as_writable_bytes(std::span(data, static_cast<std::size_t>(size))));
  if (got < 0 && is_worth_retrying()) BIO_set_retry_read(bio);
  return static_cast<int>(got);
}

long bio_control(BIO* /*bio*/, int command, long /*number*/, void* /*pointer*/) {
  return command == BIO_CTRL_FLUSH ? 1 : 0;
}

const BIO_METHOD* bio_method() {
  static const BIO_METHOD* const kMethod = [] {
    BIO_METHOD* method = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "talus socket");
    if (method == nullptr) throw std::bad_alloc();
    BIO_meth_set_write(method, bio_write);
    BIO_meth_set_read(method, bio_read);
    BIO_meth_set_ctrl(method, bio_control);
    return method;
  }();
  return kMethod;
}

/// What OpenSSL says of its last failure on this thread.
std::string last_fault() {
  const unsigned long code = ERR_get_error();
  const char* reason = code == 0 ? nullptr : ERR_reason_error_string(code);
  ERR_clear_error();
  return reason == nullptr ? "cannot be used" : reason;
}

/// A key that asks for a password would ask the terminal, and wait for ever.
int no_password(char* /*into*/, int /*size*/, int /*is_writing*/, void* /*user*/) {
  return 0;
}

/// HTTP/1.1 is all that is spoken; a client that only offers something else is told so in the handshake.
int choose_protocol(SSL* /*ssl*/, const unsigned char** out, unsigned char* out_size, const unsigned char* offered,
                    unsigned offered_size, void* /*user*/) {
  static constexpr std::string_view kOurs = "\x08http/1.1";
  unsigned char* chosen = nullptr;
  const int found = SSL_select_next_proto(&chosen, out_size, reinterpret_cast<const unsigned char*>(kOurs.data()),
                                          kOurs.size(), offered, offered_size);
  *out = chosen;
  return found == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

std::int64_t expiry(const X509* certificate) {
  std::tm date{};
  if (certificate == nullptr || ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &date) != 1) return 0;
  return static_cast<std::int64_t>(::timegm(&date));
}

}  // namespace

void TlsSession::Free::operator()(ssl_st* ssl) const {
  SSL_free(ssl);
}

bool TlsSession::is_established() const {
  return SSL_is_init_finished(ssl_.get()) != 0;
}

TlsProgress TlsSession::progress(int result, std::size_t bytes) {
  if (result == 1) return {bytes, TlsWant::kNothing, false};
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return {0, TlsWant::kReadable, false};
    case SSL_ERROR_WANT_WRITE:
      return {0, TlsWant::kWritable, false};
    case SSL_ERROR_ZERO_RETURN:
      return {0, TlsWant::kNothing, true};
    default:
      // OpenSSL forbids any further call, a goodbye included.
      is_broken_ = true;
      ERR_clear_error();
      return {0, TlsWant::kNothing, true};
  }
}

TlsProgress TlsSession::read(std::span<std::byte> into) {
  if (is_broken_) return {0, TlsWant::kNothing, true};
  ERR_clear_error();  // the queue is the thread's: what another connection left there is not ours
  std::size_t got = 0;
  const int result = SSL_read_ex(ssl_.get(), into.data(), into.size(), &got);
  return progress(result, got);
}

TlsProgress TlsSession::write(std::span<const std::byte> bytes) {
  if (is_broken_) return {0, TlsWant::kNothing, true};
  ERR_clear_error();
  std::size_t sent = 0;
  const int result = SSL_write_ex(ssl_.get(), bytes.data(), bytes.size(), &sent);
  return progress(result, sent);
}

void TlsSession::say_goodbye() {
  if (is_broken_ || !is_established()) return;
  ERR_clear_error();
  if (SSL_shutdown(ssl_.get()) < 0) ERR_clear_error();
}

void TlsContext::Free::operator()(ssl_ctx_st* context) const {
  SSL_CTX_free(context);
}

std::expected<std::shared_ptr<const TlsContext>, std::string> TlsContext::load(const std::string& certificate_file,
                                                                               const std::string& key_file) {
  ERR_clear_error();
  const std::shared_ptr<TlsContext> out(new TlsContext);
  out->context_.reset(SSL_CTX_new(TLS_server_method()));
  SSL_CTX* context = out->context_.get();
  if (context == nullptr) throw std::bad_alloc();
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_mode(context,
                   SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER | SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_alpn_select_cb(context, choose_protocol, nullptr);
  SSL_CTX_set_default_passwd_cb(context, no_password);
  if (SSL_CTX_use_certificate_chain_file(context, certificate_file.c_str()) != 1) {
    return std::unexpected(certificate_file + ": no certificate in PEM: " + last_fault());
  }
  if (SSL_CTX_use_PrivateKey_file(context, key_file.c_str(), SSL_FILETYPE_PEM) != 1) {
    return std::unexpected(key_file + ": no key in PEM of this certificate: " + last_fault());
  }
  if (SSL_CTX_check_private_key(context) != 1) {
    return std::unexpected(key_file + ": is not the key of " + certificate_file);
  }
  out->expires_unix_s_ = expiry(SSL_CTX_get0_certificate(context));
  return out;
}

std::unique_ptr<TlsSession> TlsContext::accept(int descriptor) const {
  SSL* ssl = SSL_new(context_.get());
  if (ssl == nullptr) throw std::bad_alloc();
  auto session = std::make_unique<TlsSession>(ssl, descriptor);
  BIO* bio = BIO_new(bio_method());
  if (bio == nullptr) throw std::bad_alloc();
  BIO_set_data(bio, &session->descriptor_);
  BIO_set_init(bio, 1);
  SSL_set_bio(ssl, bio, bio);
  SSL_set_accept_state(ssl);
  return session;
}

}  // namespace talus::server
