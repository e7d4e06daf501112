#include "server/net/static_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/base/hash.hpp"

namespace talus::server {

namespace {

std::string_view content_type_of(const std::filesystem::path& path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 20> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".wasm", "application/wasm"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".webp", "image/webp"},
      {".ico", "image/x-icon"},
      {".ktx2", "image/ktx2"},
      {".glb", "model/gltf-binary"},
      {".drc", "application/octet-stream"},
      {".woff2", "font/woff2"},
      {".ttf", "font/ttf"},
      {".txt", "text/plain; charset=utf-8"},
      {".md", "text/plain; charset=utf-8"},
  }};
  const std::string extension = path.extension().string();
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& t) { return t.first == extension; });
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

std::string etag_of(const std::vector<std::byte>& bytes) {
  std::uint64_t hash = mix64(bytes.size());
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001B3ULL;  // FNV-1a
  return fmt::format("\"{:016x}\"", mix64(hash));
}

std::expected<std::vector<std::byte>, std::string> read_file(const std::filesystem::path& path, std::size_t bytes_max) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) return std::unexpected(fmt::format("cannot open {}", path.string()));
  const std::streamoff size = in.tellg();
  if (size < 0 || static_cast<std::uintmax_t>(size) > bytes_max) {
    return std::unexpected(
        fmt::format("{}: the viewer's files are larger than {} bytes in all", path.string(), StaticFiles::kBytesMax));
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), size);  // NOLINT: the standard's streams read chars
  if (!in) return std::unexpected(fmt::format("cannot read {}", path.string()));
  return bytes;
}

}  // namespace

std::expected<StaticFiles, std::string> StaticFiles::load(const std::filesystem::path& folder) {
  StaticFiles out;
  std::size_t bytes = 0;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!it->is_regular_file()) continue;
    if (out.files_.size() == kFilesMax) return std::unexpected(fmt::format("more than {} files", kFilesMax));
    auto content = read_file(it->path(), kBytesMax - bytes);
    if (!content) return std::unexpected(content.error());
    bytes += content->size();
    auto file = std::make_shared<StaticFile>();
    file->etag = etag_of(*content);
    file->bytes = std::move(*content);
    file->content_type = content_type_of(it->path());
    const std::string name = "/" + it->path().lexically_relative(folder).generic_string();
    file->is_immutable = name.starts_with("/assets/");
    out.files_.emplace(name, std::move(file));
  }
  if (error) return std::unexpected(fmt::format("cannot read {}: {}", folder.string(), error.message()));
  return out;
}

StaticFileRef StaticFiles::find(std::string_view path) const {
  const auto found = files_.find(path.ends_with('/') ? std::string(path) + "index.html" : std::string(path));
  return found == files_.end() ? nullptr : found->second;
}

}  // namespace talus::server
