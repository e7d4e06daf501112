#include "client_sample/cli/files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "protocol/manifest_toml.hpp"

namespace talus::cli {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

void complain(std::string_view verb, const std::string& path) {
  fmt::print(stderr, "talus: cannot {} {}: {}\n", verb, path, std::strerror(errno));
}

}  // namespace

bool has_file(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

std::optional<std::string> load_file(const std::string& path, std::size_t bytes_max) {
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return complain("read", path), std::nullopt;
  std::string out(bytes_max + 1, '\0');
  out.resize(std::fread(out.data(), 1, out.size(), file.get()));
  if (std::ferror(file.get()) != 0) return complain("read", path), std::nullopt;
  if (out.size() > bytes_max) {
    fmt::print(stderr, "talus: {} is larger than {} bytes\n", path, bytes_max);
    return std::nullopt;
  }
  return out;
}

bool store_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
  }
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) return complain("write", path), false;
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  // The last bytes may fail only now, on a full disk for one.
  const bool is_closed = std::fclose(file.release()) == 0;
  if (!is_written || !is_closed) complain("write", path);
  return is_written && is_closed;
}

std::expected<Manifest, ExitCode> load_manifest(const std::string& path) {
  if (path.empty()) return Manifest{};
  const auto text = load_file(path, protocol::kTomlBytesMax);
  if (!text) return std::unexpected(kFailed);
  auto manifest = protocol::parse_manifest(*text, path);
  if (manifest) return std::move(*manifest);
  for (const protocol::TextFault& fault : manifest.error()) fmt::print(stderr, "{}\n", protocol::describe(fault));
  return std::unexpected(kBadManifest);
}

}  // namespace talus::cli
