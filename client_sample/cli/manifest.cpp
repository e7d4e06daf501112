// talus manifest: the TOML files of worlds.
#include <fmt/format.h>

#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "protocol/manifest_toml.hpp"

namespace talus::cli {

ExitCode manifest_check(const std::string& file) {
  const auto manifest = load_manifest(file);
  if (!manifest) return manifest.error();
  fmt::print("{}: a sound world, \"{}\", hash {}\n", file, manifest->name, protocol::world_hash(*manifest));
  return kDone;
}

ExitCode manifest_explain(const ExplainOptions& options) {
  const auto manifest = load_manifest(options.manifest);
  if (!manifest) return manifest.error();
  if (options.name.empty()) {
    fmt::print("{}", protocol::format_manifest(*manifest));
    return kDone;
  }
  const std::string text = protocol::format_parameters(*manifest, options.name);
  if (!text.empty()) {
    fmt::print("{}", text);
    return kDone;
  }
  const std::string_view near = protocol::nearest_parameter(options.name);
  fmt::print(
      stderr, "talus: there is no parameter or section \"{}\"{}\n", options.name,
      near.empty() ? std::string("; `talus manifest explain` prints all") : fmt::format(", did you mean {}?", near));
  return kUsage;
}

ExitCode manifest_diff(const std::string& from, const std::string& to) {
  const auto a = load_manifest(from);
  const auto b = load_manifest(to);
  if (!a) return a.error();
  if (!b) return b.error();
  if (*a == *b) {
    fmt::print("the same world, hash {}\n", protocol::world_hash(*a));
    return kDone;
  }
  const auto line = [](std::string_view key, std::string_view before, std::string_view after, std::string_view unit) {
    fmt::print("{:<30} {} -> {}{}{}\n", key, before, after, unit.empty() ? "" : " ", unit);
  };
  if (a->name != b->name) line("name", a->name, b->name, "");
  if (a->seed != b->seed) line("seed", std::to_string(a->seed), std::to_string(b->seed), "");
  const std::span<const ParameterInfo> parameters = manifest_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (a->values[i] == b->values[i]) continue;
    line(parameters[i].name, protocol::format_number(a->values[i]), protocol::format_number(b->values[i]),
         parameters[i].unit);
  }
  return kDone;
}

}  // namespace talus::cli
