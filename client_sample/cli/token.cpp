// talus token: keys of join tokens, and tokens.
#include <fcntl.h>
#include <fmt/format.h>
#include <jwt.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "protocol/limits.hpp"

namespace talus::cli {

namespace {

/// 256 random bits in a file that only its owner reads.
ExitCode make_key(const std::string& path) {
  std::array<unsigned char, protocol::kTokenKeyBytesMin> bits{};
  if (::getentropy(bits.data(), bits.size()) != 0) {
    fmt::print(stderr, "talus: the system gives no random bytes\n");
    return kFailed;
  }
  std::string text;
  for (const unsigned char byte : bits) text += fmt::format("{:02x}", byte);
  text += '\n';
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const bool is_written = file >= 0 && ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (file >= 0) ::close(file);
  if (is_written) return kDone;
  fmt::print(stderr, "talus: {} cannot be written; a key that is there already is not replaced\n", path);
  return kFailed;
}

std::int64_t now_unix_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// The token, or nothing when memory is out.
std::string signed_token(const TokenOptions& options, const std::string& key) {
  jwt_t* raw = nullptr;
  if (jwt_new(&raw) != 0) return {};
  const std::unique_ptr<jwt_t, decltype(&jwt_free)> token(raw, &jwt_free);
  const std::int64_t now = now_unix_s();
  bool is_good = jwt_add_grant(raw, "world", options.world.c_str()) == 0;
  is_good = is_good && jwt_add_grant_int(raw, "iat", now) == 0;
  is_good = is_good && jwt_add_grant_int(raw, "exp", now + static_cast<std::int64_t>(options.hours * 3600)) == 0;
  is_good = is_good && (options.subject.empty() || jwt_add_grant(raw, "sub", options.subject.c_str()) == 0);
  const auto* bytes = reinterpret_cast<const unsigned char*>(key.data());
  is_good = is_good && jwt_set_alg(raw, JWT_ALG_HS256, bytes, static_cast<int>(key.size())) == 0;
  if (!is_good) return {};
  const std::unique_ptr<char, void (*)(void*)> text(jwt_encode_str(raw), &std::free);
  return text == nullptr ? std::string() : std::string(text.get());
}

}  // namespace

ExitCode token(const TokenOptions& options) {
  if (options.makes_key) return make_key(options.key_file);
  auto key = load_file(options.key_file, protocol::kTokenKeyBytesMax);
  if (!key) return kFailed;
  while (key->ends_with('\n') || key->ends_with('\r')) key->pop_back();
  if (key->size() < protocol::kTokenKeyBytesMin) {
    fmt::print(stderr, "talus: {}: a key has at least {} bytes; --make-key makes one\n", options.key_file,
               protocol::kTokenKeyBytesMin);
    return kFailed;
  }
  const std::string text = signed_token(options, *key);
  if (text.empty()) {
    fmt::print(stderr, "talus: the token could not be signed\n");
    return kFailed;
  }
  fmt::print("{}\n", text);
  return kDone;
}

}  // namespace talus::cli
