#include "protocol/tile_bytes.hpp"

#include <memory>

#include <zstd.h>

namespace talus::protocol {
namespace {

struct Free {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

std::expected<void, CodecError> append_packed(std::span<const std::byte> content, int level,
                                              std::vector<std::byte>& out) {
  // A context is a quarter of a megabyte that would be cleared for every tile: each thread keeps one.
  thread_local const std::unique_ptr<ZSTD_CCtx, Free> kContext(ZSTD_createCCtx());
  const std::size_t begin = out.size();
  out.resize(begin + ZSTD_compressBound(content.size()));
  const std::size_t written =
      ZSTD_compressCCtx(kContext.get(), out.data() + begin, out.size() - begin, content.data(), content.size(), level);
  if (ZSTD_isError(written) != 0) return std::unexpected(CodecError::kInternal);
  out.resize(begin + written);
  return {};
}

std::expected<std::vector<std::byte>, CodecError> unpack(std::span<const std::byte> packed, std::size_t content_bytes) {
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != content_bytes ||
      ZSTD_findFrameCompressedSize(packed.data(), packed.size()) != packed.size()) {
    return std::unexpected(CodecError::kMalformed);
  }
  thread_local const std::unique_ptr<ZSTD_DCtx, Free> kContext(ZSTD_createDCtx());
  std::vector<std::byte> out(content_bytes);
  const std::size_t got = ZSTD_decompressDCtx(kContext.get(), out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0 || got != content_bytes) return std::unexpected(CodecError::kMalformed);
  return out;
}

}  // namespace talus::protocol
