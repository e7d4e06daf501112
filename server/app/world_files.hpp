// The worlds a server hosts, from manifest files.
#pragma once

#include <expected>
#include <span>
#include <string>

#include "server/world/world.hpp"

namespace talus::server {

/// Largest text that is read of any file.
std::expected<std::string, std::string> read_text_file(const std::string& path);

/// One world a file, or the built-in one when there are no files. Every fault, one a line: file, line, key, what is
/// allowed; worlds of one name.
std::expected<Worlds, std::string> load_worlds(std::span<const std::string> files);

}  // namespace talus::server
