#include "client_sample/library/client_socket.hpp"

#include <map>
#include <string>

#include <asio/ip/address.hpp>
#include <asio/ssl/context.hpp>
#include <asio/ssl/host_name_verification.hpp>

namespace talus::client {
namespace {

/// The authorities of one file, or of the system for an empty name. Read once a thread, since reading the system's
/// takes tens of milliseconds and a loop has one thread. nullptr and why when the file cannot be used.
std::shared_ptr<asio::ssl::context> authorities(const std::string& file, asio::error_code& error) {
  thread_local std::map<std::string, std::shared_ptr<asio::ssl::context>> known;
  if (const auto found = known.find(file); found != known.end()) return found->second;
  auto context = std::make_shared<asio::ssl::context>(asio::ssl::context::tls_client);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  file.empty() ? context->set_default_verify_paths(error) : context->load_verify_file(file, error);
  if (error) return nullptr;
  context->set_verify_mode(asio::ssl::verify_peer);
  return known[file] = std::move(context);
}

}  // namespace

asio::error_code ClientSocket::begin_tls() {
  asio::error_code error;
  const auto context = authorities(server_.ca_file, error);
  if (context == nullptr) return error;
  secure_ = std::make_unique<Secure>(socket_, *context);
  secure_->set_verify_callback(asio::ssl::host_name_verification(server_.host), error);
  if (error) return error;
  // A server of many names chooses its certificate by this; an address is no name (RFC 6066, section 3).
  asio::ip::make_address(server_.host, error);
  if (error) SSL_set_tlsext_host_name(secure_->native_handle(), server_.host.c_str());
  return {};
}

void ClientSocket::set_no_delay() {
  asio::error_code ignored;
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
}

void ClientSocket::end_sending() {
  asio::error_code ignored;
  if (!secure_) socket_.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

void ClientSocket::close() {
  asio::error_code ignored;
  socket_.close(ignored);
}

}  // namespace talus::client
