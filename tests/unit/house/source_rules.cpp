#include "tests/unit/house/source_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <map>
#include <optional>
#include <ranges>
#include <span>

namespace talus::house {
namespace {

struct Room {
  std::string_view name;
  std::vector<std::string_view> below;  ///< rooms it may include besides itself; "core" stands for all of core
};

// The order of the house. A room that is not here is a fault: whoever adds one gives it a place.
const std::vector<Room>& rooms() {
  static const std::vector<Room> all = [] {
    std::vector<Room> out{{"core/base", {}},
                          {"core/grid", {"core/base"}},
                          {"core/noise", {"core/base", "core/grid"}},
                          {"core/plates", {"core/base", "core/grid", "core/noise"}},
                          {"core/strata", {"core/base", "core/grid", "core/noise"}},
                          {"core/erosion", {"core/base", "core/grid", "core/noise"}},
                          {"core/landforms", {"core/base", "core/grid", "core/noise"}}};
    std::vector<std::string_view> below;
    for (const Room& room : out) {
      below.push_back(room.name);
    }
    out.push_back({"core/volume", below});
    out.push_back({"core/edit", below});
    below.insert(below.end(), {"core/volume", "core/edit"});
    out.push_back({"core/world", below});
    below.push_back("core/world");
    out.push_back({"core/map", below});
    out.push_back({"core/mesh", below});

    out.push_back({"protocol", {"core"}});

    below = {"core", "protocol"};
    out.push_back({"server/schedule", below});
    out.push_back({"server/observe", below});
    below.insert(below.end(), {"server/schedule", "server/observe"});
    out.push_back({"server/cache", below});
    out.push_back({"server/storage", below});
    below.insert(below.end(), {"server/cache", "server/storage"});
    out.push_back({"server/world", below});
    below.push_back("server/world");
    out.push_back({"server/net", below});
    below.push_back("server/net");
    out.push_back({"server/app", below});

    out.push_back({"client_sample/library", {"core", "protocol"}});
    out.push_back({"client_sample/load", {"core", "protocol", "client_sample/library"}});
    out.push_back({"client_sample/cli", {"core", "protocol", "client_sample/library", "client_sample/load"}});
    return out;
  }();
  return all;
}

struct Library {
  std::string_view prefix;              ///< of what stands between < > or " "
  std::vector<std::string_view> rooms;  ///< that may include it
  std::size_t sources_max;              ///< that include it, over the whole project; 0: any number, headers too
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> all{
      {"asio", {"server/net", "server/app", "client_sample/library", "client_sample/cli", "client_sample/load"}, 0},
      {"draco/", {"protocol"}, 2},
      {"meshoptimizer.h", {"protocol"}, 1},
      {"png.h", {"protocol"}, 1},
      {"flatbuffers/", {"protocol"}, 2},
      {"talus_generated.h", {"protocol"}, 2},
      {"zstd.h", {"protocol", "server/storage"}, 0},
      {"toml++/", {"protocol", "server/app"}, 2},
      {"nlohmann/", {"protocol", "server/observe", "server/app", "client_sample/library", "client_sample/cli"}, 5},
      {"CLI/", {"server/app", "client_sample/cli", "client_sample/load"}, 3},
      {"spdlog/", {"server/observe"}, 1},
      {"prometheus/", {"server/observe"}, 1},
      {"openssl/", {"protocol", "server/net", "server/storage"}, 0},
      {"jwt.h", {"server/net", "client_sample/cli"}, 2},
      {"sqlite3.h", {"server/storage"}, 0},
      {"llhttp.h", {"server/net", "client_sample/library"}, 0},
      {"wslay/", {"server/net", "client_sample/library"}, 0},
      {"hwy/", {"core"}, 0},
  };
  return all;
}

// What core never touches: I/O, clocks, threads, locks, and chance.
constexpr std::array<std::string_view, 14> kNeverInCore{
    "atomic", "chrono", "condition_variable", "filesystem", "fstream", "future",   "iostream",
    "mutex",  "random", "shared_mutex",       "stop_token", "thread",  "unistd.h", "ctime"};

constexpr std::array<std::string_view, 5> kThreadStarters{"server/schedule/job_pool.cpp", "server/net/server.cpp",
                                                          "server/app/main.cpp", "client_sample/library/connection.cpp",
                                                          "client_sample/cli/strips.cpp"};

constexpr std::size_t kSourceLinesMax = 400;
constexpr std::size_t kHeaderLinesMax = 200;

struct Line {
  std::size_t number;  ///< from 1
  std::string_view text;
};

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out.push_back({out.size() + 1, text.substr(0, end)});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// What an #include line names, or nothing.
std::optional<std::string_view> included(std::string_view line) {
  constexpr std::string_view kInclude = "include";
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with(kInclude)) return std::nullopt;
  line.remove_prefix(kInclude.size());
  skip_blanks();
  if (line.empty() || (line.front() != '<' && line.front() != '"')) return std::nullopt;
  const char close = line.front() == '<' ? '>' : '"';
  line.remove_prefix(1);
  const std::size_t end = line.find(close);
  if (end == std::string_view::npos) return std::nullopt;
  return line.substr(0, end);
}

bool is_within(std::string_view room, std::string_view above) {
  return room == above || (room.starts_with(above) && room.substr(above.size()).starts_with('/'));
}

bool is_header(std::string_view path) {
  return path.ends_with(".hpp");
}
bool is_test(std::string_view path) {
  return path.starts_with("tests/");
}
bool is_cpp(std::string_view path) {
  return is_header(path) || path.ends_with(".cpp");
}

bool is_ours(std::string_view header) {
  constexpr std::array<std::string_view, 5> kTops{"core/", "protocol/", "server/", "client_sample/", "tests/"};
  return std::ranges::any_of(kTops, [&](std::string_view top) { return header.starts_with(top); });
}

bool is_word_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool has_word(std::string_view line, std::string_view word) {
  for (std::size_t at = line.find(word); at != std::string_view::npos; at = line.find(word, at + 1)) {
    const bool begins = at == 0 || !is_word_part(line[at - 1]);
    const std::size_t after = at + word.size();
    if (begins && (after == line.size() || !is_word_part(line[after]))) return true;
  }
  return false;
}

bool has_any(std::string_view line, std::initializer_list<std::string_view> needles) {
  return std::ranges::any_of(needles, [&](std::string_view n) { return line.find(n) != std::string_view::npos; });
}

std::string lower(std::string_view text) {
  std::string out{text};
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// The name of a type whose definition begins at the left of this line.
std::optional<std::string_view> type_defined(std::string_view line) {
  if (!line.ends_with('{')) return std::nullopt;
  for (const std::string_view kind : {"struct ", "class ", "union ", "enum class "}) {
    if (!line.starts_with(kind)) continue;
    line.remove_prefix(kind.size());
    return line.substr(0, line.find(' '));
  }
  return std::nullopt;
}

void thread_and_clock_faults(const Source& source, const Line& line, std::vector<Fault>& out) {
  if (is_test(source.path)) return;
  const bool starts = has_any(
      line.text, {"std::thread{", "std::thread(", "std::jthread{", "std::jthread(", "std::async", "pthread_create"});
  const bool holds = has_any(line.text, {"<std::thread>", "<std::jthread>"}) ||
                     (has_any(line.text, {"std::thread ", "std::jthread "}) && !source.path.ends_with(".hpp"));
  if ((starts || holds) && is_cpp(source.path) && !is_header(source.path) &&
      std::ranges::find(kThreadStarters, source.path) == kThreadStarters.end()) {
    out.push_back({source.path, line.number, "starts a thread; only the files in kThreadStarters do"});
  }
  const bool reads_clock = has_any(line.text, {"_clock::now", "clock_gettime", "gettimeofday", "std::time("});
  if (reads_clock && !is_within(room_of(source.path), "client_sample") &&
      !source.path.starts_with("server/schedule/clock.")) {
    out.push_back({source.path, line.number, "reads a clock; only server/schedule/clock does"});
  }
}

}  // namespace

std::string room_of(std::string_view path) {
  const std::size_t first = path.find('/');
  const std::string_view top = path.substr(0, first);
  if (top != "core" && top != "server" && top != "client_sample") return std::string{top};
  const std::size_t second = path.find('/', first + 1);
  return std::string{path.substr(0, second)};
}

std::vector<Fault> include_order_faults(const Source& source) {
  std::vector<Fault> out;
  if (is_test(source.path)) return out;
  const std::string room = room_of(source.path);
  const auto place = std::ranges::find(rooms(), room, &Room::name);
  if (place == rooms().end()) {
    out.push_back({source.path, 0, "is in " + room + ", which has no place in the order of rooms"});
    return out;
  }
  for (const Line& line : lines_of(source.text)) {
    const auto header = included(line.text);
    if (!header || !is_ours(*header)) continue;
    const std::string other = room_of(*header);
    if (other == room) continue;
    const bool below = std::ranges::any_of(place->below, [&](std::string_view r) { return is_within(other, r); });
    if (!below) {
      out.push_back({source.path, line.number, room + " includes " + std::string{*header} + ", which is not below it"});
    }
  }
  return out;
}

std::vector<Fault> library_faults(const Source& source) {
  std::vector<Fault> out;
  if (is_test(source.path)) return out;
  const std::string room = room_of(source.path);
  const bool in_core = is_within(room, "core");
  for (const Line& line : lines_of(source.text)) {
    const auto header = included(line.text);
    if (!header || is_ours(*header)) continue;
    const auto library =
        std::ranges::find_if(libraries(), [&](const Library& l) { return header->starts_with(l.prefix); });
    if (library != libraries().end() &&
        std::ranges::none_of(library->rooms, [&](std::string_view r) { return is_within(room, r); })) {
      out.push_back({source.path, line.number, room + " does not own " + std::string{*header}});
    }
    if (in_core && std::ranges::find(kNeverInCore, *header) != kNeverInCore.end()) {
      out.push_back({source.path, line.number, "core is pure: no <" + std::string{*header} + ">"});
    }
    const bool foreign = header->find('/') != std::string_view::npos;
    if (in_core && foreign && !header->starts_with("glm/") && !header->starts_with("hwy/")) {
      out.push_back({source.path, line.number, "core uses std, GLM and Highway only, not " + std::string{*header}});
    }
  }
  return out;
}

std::vector<Fault> heavy_library_faults(const std::vector<Source>& sources) {
  std::vector<Fault> out;
  std::map<std::string_view, std::vector<std::string>> users;
  for (const Source& source : sources) {
    if (is_test(source.path)) continue;
    for (const Line& line : lines_of(source.text)) {
      const auto header = included(line.text);
      if (!header) continue;
      for (const Library& library : libraries()) {
        if (library.sources_max == 0 || !header->starts_with(library.prefix)) continue;
        if (is_header(source.path)) {
          out.push_back({source.path, line.number, std::string{*header} + " in a header costs every includer seconds"});
        }
        std::vector<std::string>& paths = users[library.prefix];
        if (std::ranges::find(paths, source.path) == paths.end()) paths.push_back(source.path);
      }
    }
  }
  for (const Library& library : libraries()) {
    const std::vector<std::string>& paths = users[library.prefix];
    if (library.sources_max == 0 || paths.size() <= library.sources_max) continue;
    std::string message =
        std::string{library.prefix} + " is compiled in more than " + std::to_string(library.sources_max) + " sources:";
    for (const std::string& path : paths) {
      message += ' ' + path;
    }
    out.push_back({paths.back(), 0, message});
  }
  return out;
}

std::vector<Fault> one_definition_faults(const std::vector<Source>& sources) {
  std::vector<Fault> out;
  std::map<std::string, std::string_view> defined_in;
  for (const Source& source : sources) {
    if (is_test(source.path) || !is_cpp(source.path)) continue;
    std::vector<std::string_view> around;
    for (const Line& line : lines_of(source.text)) {
      if (line.text.starts_with("namespace ") && line.text.ends_with('{')) around.push_back(line.text);
      if (line.text.starts_with("}  // namespace") && !around.empty()) around.pop_back();
      const auto name = type_defined(line.text);
      if (!name || std::ranges::find(around, "namespace {") != around.end()) continue;
      std::string full;
      for (const std::string_view name_space : around) full += name_space;
      full += *name;
      const auto [known, is_first] = defined_in.try_emplace(std::move(full), source.path);
      if (is_first || known->second == source.path) continue;
      out.push_back(
          {source.path, line.number, "defines " + std::string{*name} + ", as does " + std::string{known->second}});
    }
  }
  return out;
}

std::vector<Fault> text_faults(const Source& source) {
  std::vector<Fault> out;
  const std::vector<Line> lines = lines_of(source.text);
  const std::size_t lines_max = is_header(source.path) ? kHeaderLinesMax : kSourceLinesMax;
  if (lines.size() > lines_max && source.path.find("_table") == std::string::npos) {
    out.push_back({source.path, 0,
                   "has " + std::to_string(lines.size()) + " lines, more than " + std::to_string(lines_max) +
                       ": a noun is missing"});
  }
  for (const Line& line : lines) {
    thread_and_clock_faults(source, line, out);
    // Spelled in two halves so that this file holds its own rule.
    for (const std::string_view word : {"TO"
                                        "DO",
                                        "FIX"
                                        "ME",
                                        "XX"
                                        "X",
                                        "HA"
                                        "CK",
                                        "TB"
                                        "D"}) {
      if (has_word(line.text, word)) out.push_back({source.path, line.number, "is unfinished: " + std::string{word}});
    }
    const std::string small = is_cpp(source.path) ? lower(line.text) : std::string{};
    for (const std::string_view word : {"for "
                                        "now",
                                        "place"
                                        "holder",
                                        "not "
                                        "implemented",
                                        "st"
                                        "ub"}) {
      if (has_word(small, word)) out.push_back({source.path, line.number, "is unfinished: " + std::string{word}});
    }
  }
  return out;
}

}  // namespace talus::house
