#include "server/storage/entry.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <initializer_list>
#include <memory>

#include "core/base/check.hpp"

namespace talus::server {

namespace {

constexpr std::uint32_t kMagic = 0x31'45'54'01;  // version 1, "TE1"
constexpr std::size_t kKindAt = 4;
constexpr std::size_t kSizeAt = 8;
constexpr std::size_t kChecksumAt = 12;
constexpr std::size_t kChecksumBytes = kEntryHeadBytes - kChecksumAt;
constexpr std::size_t kDigestBytes = 32;

using Digest = std::array<std::byte, kDigestBytes>;
using Bytes = std::span<const std::byte>;

Digest sha256(std::initializer_list<Bytes> parts) {
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  const std::unique_ptr<EVP_MD_CTX, Free> context(EVP_MD_CTX_new());
  TALUS_CHECK(context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
  for (const Bytes part : parts) TALUS_CHECK(EVP_DigestUpdate(context.get(), part.data(), part.size()) == 1);
  Digest out{};
  TALUS_CHECK(EVP_DigestFinal_ex(context.get(), reinterpret_cast<unsigned char*>(out.data()), nullptr) == 1);
  return out;
}

void write_u32(std::span<std::byte> into, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) into[i] = static_cast<std::byte>(value >> (8 * i));
}

std::uint32_t read_u32(Bytes from) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(from[i]);
  return value;
}

Digest checksum(std::string_view name, Bytes before_checksum, Bytes payload) {
  // The name's length keeps a byte from moving between the name and the head unseen.
  std::array<std::byte, 4> name_bytes{};
  write_u32(name_bytes, static_cast<std::uint32_t>(name.size()));
  return sha256({name_bytes, std::as_bytes(std::span(name)), before_checksum, payload});
}

}  // namespace

EntryHead encode_entry_head(std::string_view name, std::uint8_t kind, Bytes payload) {
  TALUS_CHECK(payload.size() <= kEntryPayloadBytesMax);
  EntryHead head{};
  write_u32(std::span(head), kMagic);
  head[kKindAt] = static_cast<std::byte>(kind);
  write_u32(std::span(head).subspan(kSizeAt), static_cast<std::uint32_t>(payload.size()));
  const Digest digest = checksum(name, Bytes(head).first(kChecksumAt), payload);
  std::copy_n(digest.begin(), kChecksumBytes, head.begin() + kChecksumAt);
  return head;
}

std::expected<std::uint8_t, EntryFault> decode_entry(std::string_view name, Bytes head, Bytes payload) {
  if (head.size() < kEntryHeadBytes) return std::unexpected(EntryFault::kTruncated);
  if (head.size() > kEntryHeadBytes) return std::unexpected(EntryFault::kSize);
  if (read_u32(head) != kMagic) return std::unexpected(EntryFault::kVersion);
  const std::size_t size = read_u32(head.subspan(kSizeAt));
  if (size > kEntryPayloadBytesMax || payload.size() > size) return std::unexpected(EntryFault::kSize);
  if (payload.size() < size) return std::unexpected(EntryFault::kTruncated);
  const Digest digest = checksum(name, head.first(kChecksumAt), payload);
  if (!std::equal(digest.begin(), digest.begin() + kChecksumBytes, head.begin() + kChecksumAt)) {
    return std::unexpected(EntryFault::kChecksum);
  }
  return std::to_integer<std::uint8_t>(head[kKindAt]);
}

std::int64_t entry_place(std::string_view name) {
  const Digest digest = sha256({std::as_bytes(std::span(name))});
  std::uint64_t place = 0;
  for (std::size_t i = 8; i-- > 0;) place = place << 8 | std::to_integer<std::uint64_t>(digest[i]);
  return static_cast<std::int64_t>(place);
}

}  // namespace talus::server
