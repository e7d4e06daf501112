#include "client_sample/cli/files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "protocol/manifest_toml.hpp"

namespace talus::cli {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

/// Writes all and closes; with `is_synced` the bytes are on the disk then.
bool write_whole(File file, std::string_view bytes, bool is_synced) {
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() &&
                          std::fflush(file.get()) == 0 && (!is_synced || ::fsync(::fileno(file.get())) == 0);
  // The last bytes may fail only now, on a full disk for one.
  return (std::fclose(file.release()) == 0) && is_written;
}

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
  const bool is_written = write_whole(std::move(file), bytes, false);
  if (!is_written) complain("write", path);
  return is_written;
}

bool replace_file(const std::string& path, std::string_view bytes) {
  namespace fs = std::filesystem;
  std::error_code fault;
  const bool is_there = fs::exists(path, fault);
  if (is_there && !fs::is_regular_file(path, fault)) return store_file(path, bytes);
  // Where a link leads to, so that the link stays one.
  const fs::path target = is_there ? fs::canonical(path, fault) : fs::absolute(path, fault);
  const std::string beside = target.string() + ".new";
  File file(std::fopen(beside.c_str(), "wb"));
  if (!file) return complain("write", beside), false;
  // The bytes reach the disk before the name does; a name of bytes that do not would be an empty file after a power
  // cut.
  if (!write_whole(std::move(file), bytes, true) || std::rename(beside.c_str(), target.c_str()) != 0) {
    complain("write", target.string());
    ::unlink(beside.c_str());
    return false;
  }
  // Where a folder cannot be synced, the old file may come back: whole as well.
  if (const File folder(std::fopen(target.parent_path().c_str(), "r")); folder) ::fsync(::fileno(folder.get()));
  return true;
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
