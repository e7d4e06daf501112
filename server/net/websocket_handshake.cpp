#include "server/net/websocket_handshake.hpp"

#include <openssl/evp.h>

#include <array>

#include "core/base/check.hpp"

namespace talus::server {

namespace {

/// 16 bytes in base64: 22 letters and "==".
bool is_key(std::string_view key) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return key.size() == 24 && key.ends_with("==") &&
         key.substr(0, 22).find_first_not_of(kLetters) == std::string_view::npos;
}

}  // namespace

std::string websocket_accept(std::string_view key) {
  const std::string text = std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  TALUS_CHECK(EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha1(), nullptr) == 1);
  std::array<unsigned char, 2 * EVP_MAX_MD_SIZE> encoded{};
  const int length = EVP_EncodeBlock(encoded.data(), digest.data(), static_cast<int>(size));
  return {encoded.begin(), encoded.begin() + length};
}

std::expected<std::string, HttpAnswer> websocket_handshake(const HttpRequest& request) {
  if (request.method != HttpMethod::kGet || !request.lists("upgrade", "websocket") ||
      !request.lists("connection", "upgrade")) {
    return std::unexpected(error_answer(426, "upgrade_required",
                                        "this route is a WebSocket: send Upgrade and Connection",
                                        "Upgrade: websocket\r\nConnection: Upgrade\r\n"));
  }
  if (request.is_http_1_0) {
    return std::unexpected(error_answer(400, "bad_version", "version: a WebSocket needs HTTP/1.1"));
  }
  if (request.field("sec-websocket-version").value_or("") != "13") {
    return std::unexpected(error_answer(426, "bad_websocket_version", "Sec-WebSocket-Version: expected 13",
                                        "Sec-WebSocket-Version: 13\r\n"));
  }
  const std::string_view key = request.field("sec-websocket-key").value_or("");
  if (!is_key(key)) {
    return std::unexpected(error_answer(400, "bad_websocket_key", "Sec-WebSocket-Key: expected 16 bytes in base64"));
  }
  return "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " +
         websocket_accept(key) + "\r\n\r\n";
}

}  // namespace talus::server
