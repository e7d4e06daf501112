#include "server/app/world_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "protocol/manifest_toml.hpp"
#include "protocol/toml_reader.hpp"

namespace talus::server {

std::expected<std::string, std::string> read_text_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return std::unexpected(path + ": is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::unexpected(path + ": cannot be opened");
  // One byte more than a text may have is enough for it to be refused as too long.
  std::string text(protocol::kTomlBytesMax + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return std::unexpected(path + ": cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

std::expected<Worlds, std::string> load_worlds(std::span<const std::string> files) {
  Worlds worlds;
  std::string faults;
  if (files.empty()) worlds.push_back(std::make_unique<const World>(Manifest{}));
  for (const std::string& file : files) {
    const auto text = read_text_file(file);
    if (!text) {
      faults += text.error() + "\n";
      continue;
    }
    auto manifest = protocol::parse_manifest(*text, file);
    if (!manifest) {
      for (const protocol::TextFault& fault : manifest.error()) faults += protocol::describe(fault) + "\n";
    } else if (world_index(worlds, manifest->name) != worlds.size()) {
      faults += fmt::format("{}: name: there is another world named {}\n", file, manifest->name);
    } else {
      worlds.push_back(std::make_unique<const World>(std::move(*manifest)));
    }
  }
  if (!faults.empty()) return std::unexpected(std::move(faults));
  return worlds;
}

}  // namespace talus::server
