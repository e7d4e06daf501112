// Whole files in and out. Says on standard error what failed.
#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "client_sample/cli/exit_code.hpp"
#include "core/world/manifest.hpp"

namespace talus::cli {

bool has_file(const std::string& path);
std::optional<std::string> load_file(const std::string& path, std::size_t bytes_max);
/// "-" is standard output.
bool store_file(const std::string& path, std::string_view bytes);
/// The same, whole or not at all: whoever reads the file, after a power cut as well, finds the old bytes or the new
/// ones. Writes `path`.new and renames it; what is no regular file is written as store_file does.
bool replace_file(const std::string& path, std::string_view bytes);

/// Every fault is printed. An empty path is the default world. kFailed: the file cannot be read; kBadManifest: its
/// content is no world.
std::expected<Manifest, ExitCode> load_manifest(const std::string& path);

}  // namespace talus::cli
