// The viewer's files, read once at the start.
//
// A request names an entry of a table, never a path of the disk, so no spelling of a path can leave the folder.
// Immutable after the start; any thread.
#pragma once

#include <cstddef>
#include <expected>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace talus::server {

struct StaticFile {
  std::vector<std::byte> bytes;
  std::string_view content_type;
  std::string etag;           ///< quoted; of the bytes
  bool is_immutable = false;  ///< its name changes with its bytes (below /assets/)
};
using StaticFileRef = std::shared_ptr<const StaticFile>;

class StaticFiles {
 public:
  StaticFiles() = default;
  /// Every regular file below `folder`, names of plain ASCII; at most kFilesMax of kBytesMax in all. The error says
  /// what could not be read.
  static std::expected<StaticFiles, std::string> load(const std::filesystem::path& folder);

  /// `path` as in the request, from its slash; "/" is "/index.html". Null when there is none.
  StaticFileRef find(std::string_view path) const;
  std::size_t size() const { return files_.size(); }

  static constexpr std::size_t kFilesMax = 4096;
  static constexpr std::size_t kBytesMax = 64 * 1024 * 1024;

 private:
  std::unordered_map<std::string, StaticFileRef> files_;
};

}  // namespace talus::server
