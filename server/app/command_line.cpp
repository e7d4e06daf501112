#include "server/app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <type_traits>

#include "server/app/policy.hpp"
#include "server/app/world_files.hpp"

namespace talus::server {

namespace {

constexpr const char* kVersion = "talusd 0.1.0";
constexpr const char* kDescription =
    "talusd serves endless eroded worlds: terrain chunks over HTTP, WebSocket and TCP, made from a manifest and a "
    "point.";
constexpr const char* kFooter =
    "\nExamples:\n"
    "  talusd                                          the built-in world on 127.0.0.1:8080\n"
    "  talusd --viewer client_sample/web/dist          with the browser viewer at http://127.0.0.1:8080/\n"
    "  talusd --world alps.toml --listen 0.0.0.0:8080  a world of your own, for everybody\n"
    "  talusd --print-config > talusd.toml             every setting, to be edited and given to --config\n"
    "\nWhen ready it prints one line of JSON on standard output; logs go to standard error. SIGTERM ends it cleanly, "
    "SIGHUP reads settings and certificates again.";

/// Faults, one a line; empty when all is well.
std::string apply_config(Settings& settings, const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return text.error() + "\n";
  const auto set = set_from_toml(settings, *text, path);
  if (set) return {};
  std::string out;
  for (const protocol::TextFault& fault : set.error()) out += protocol::describe(fault) + "\n";
  return out;
}

/// The texts given for each setting, in order of the table.
using Given = std::vector<std::vector<std::string>>;

std::string apply_flags(Settings& settings, const Given& given) {
  std::string out;
  const auto table = setting_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (given[i].empty()) continue;
    if (const auto* list = std::get_if<1>(&table[i].place)) (*list)(settings).clear();
    for (const std::string& text : given[i]) {
      if (const auto fault = set_from_text(settings, table[i], text)) {
        out += fmt::format("{}: {}\n", flag_of(table[i]), *fault);
      }
    }
  }
  return out;
}

/// CLI11's message, and for an unknown flag the one that was probably meant.
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv) {
  std::string text = std::string("talusd: ") + error.what() + "\n";
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options()) flags.push_back(option->get_name());
  const std::vector<std::string_view> views(flags.begin(), flags.end());
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = std::string_view(argv[i]).substr(0, std::string_view(argv[i]).find('='));
    if (!word.starts_with("--") || std::find(views.begin(), views.end(), word) != views.end()) continue;
    const std::string_view near = protocol::nearest_word(word, views);
    if (!near.empty()) text += fmt::format("talusd: {}: did you mean {}?\n", word, near);
  }
  return text + "talusd: --help lists what there is\n";
}

void add_flags(CLI::App& app, Given& given) {
  const auto table = setting_table();
  Settings initial;
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::string meaning(table[i].meaning);
    std::visit(
        [&](auto place) {
          const auto& value = place(initial);
          using Value = std::remove_cvref_t<decltype(value)>;
          if constexpr (std::is_arithmetic_v<Value>) {
            meaning += fmt::format(" [{}]", protocol::format_number(static_cast<double>(value)));
          } else if constexpr (std::is_same_v<Value, std::string>) {
            if (!value.empty()) meaning += fmt::format(" [{}]", value);
          }
        },
        table[i].place);
    app.add_option(flag_of(table[i]), given[i], meaning)
        ->type_name(std::string(table[i].value_name))
        ->type_size(1)
        ->expected(1, table[i].place.index() == 1 ? 64 : 1)
        ->allow_extra_args(false)
        ->group(table[i].is_limit ? "Limits" : "Settings");
  }
}

}  // namespace

std::variant<Serve, PrintAndEnd> parse_command_line(int argc, const char* const* argv) {
  CLI::App app{kDescription, "talusd"};
  app.footer(kFooter);
  app.set_version_flag("--version", kVersion);
  app.get_formatter()->column_width(34);
  Given given(setting_table().size());
  std::string config;
  bool is_check = false;
  bool is_print = false;
  app.add_option("--config", config, "Settings as TOML; the keys are the flags' names with underscores")
      ->type_name("FILE")
      ->group("Settings");
  app.add_flag("--check-config", is_check, "Say what is wrong with settings and worlds, or that nothing is, and end");
  app.add_flag("--print-config", is_print, "Print every setting as TOML, and end");
  add_flags(app, given);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return PrintAndEnd{app.help(), 0};
  } catch (const CLI::CallForVersion&) {
    return PrintAndEnd{std::string(kVersion) + "\n", 0};
  } catch (const CLI::ParseError& error) {
    return PrintAndEnd{explain(app, error, argc, argv), 2};
  }
  Settings settings;
  std::string faults;
  if (!config.empty()) faults += apply_config(settings, config);
  faults += apply_flags(settings, given);
  if (faults.empty()) {
    for (const SettingFault& fault : setting_faults(settings))
      faults += fmt::format("{}: {}\n", fault.key, fault.message);
  }
  if (!faults.empty()) return PrintAndEnd{faults, 2};
  if (is_print) return PrintAndEnd{format_settings(settings), 0};
  if (!is_check) return Serve{std::move(settings)};
  const auto worlds = load_worlds(settings.world);
  if (!worlds) return PrintAndEnd{worlds.error(), 2};
  const auto policy = make_policy(settings);
  if (!policy) return PrintAndEnd{policy.error(), 2};
  return PrintAndEnd{"the configuration is good\n", 0};
}

}  // namespace talus::server
