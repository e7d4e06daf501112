#include "client_sample/cli/arguments.hpp"

#include <functional>

#include <CLI/CLI.hpp>

#include "client_sample/cli/commands.hpp"
#include "core/map/map_view.hpp"

namespace talus::cli {
namespace {

constexpr const char* kFooter = R"(Examples:
  talus info
  talus get 5/0/1/0 -o chunk.glb
  talus get 4/0/0/0 -o hills.height
  talus get 4/0/0/0 -o hills.obj --local --manifest worlds/alps.toml
  talus fly --from 0,400,0 --to 2000,400,0 --speed 50 --seconds 60
  talus fly --viewers 50 --seconds 300 --json
  talus fly --until-complete --far 2000 --seconds 60     # time to a complete view
  talus load --fly 50 --fetch 1 --metrics http://127.0.0.1:9090   # a crowd, and one who asks for chunks over HTTP
  talus pregen --area 0,0,4 --progress start.pregen      # 4 km around the origin, into the server's disk cache
  talus map --area 0,0,64 -o map.png                     # 64 km around the origin
  talus map --area 0,0,4 --layer materials --contours 50 --size 2048 -o rocks.png
  talus section --from -2000,0 --to 2000,500 -o cut.png
  talus view --at 4830,20,39285 --yaw 200 -o arch.png
  talus manifest check worlds/alps.toml
  talus manifest explain erosion.gully_weight
  talus token --make-key join.key && talus token join.key --world default --hours 8

Exit codes:
  0 done   1 server, network or file failed   2 wrong command line   3 chunk without a surface
  4 manifest with faults   5 fly: a viewer failed or its view was never complete; load: faults; pregen: time was up)";

void add_server(CLI::App& app, ServerOptions& server) {
  app.add_option("--server", server.url, "URL of the server: http or https; fly also takes tcp:// and tls://HOST:PORT")
      ->capture_default_str();
  app.add_option("--token", server.token, "join token, for a server that asks for one (talus token)");
  app.add_option("--ca", server.ca_file, "PEM file of the authorities to trust, instead of the system's");
  app.add_option("--world", server.world, "name of the world")
      ->capture_default_str()
      ->check([](const std::string& name) {
        const bool is_name = !name.empty() && name.size() <= 32 &&
                             name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
        return is_name ? std::string() : "\"" + name + "\" is no world: 1 to 32 characters of a-z, 0-9, _ and -";
      });
}

struct Arguments {
  GetOptions get;
  InfoOptions info;
  FlyOptions fly;
  LoadOptions load;
  PregenOptions pregen;
  MapOptions map;
  SectionOptions section;
  ViewOptions view;
  SurveyOptions survey;
  GalleryOptions gallery;
  std::string checked;
  ExplainOptions explain;
  TokenOptions token;
  std::string from;
  std::string to;
  std::function<ExitCode()> command;
};

void add_get(CLI::App& app, Arguments& arguments) {
  CLI::App* get = app.add_subcommand(
      "get", "Write one chunk to a file: .drc .mesh .glb .obj .ply .density, or its column: .height");
  get->add_option("chunk", arguments.get.key,
                  "LOD/X/Y/Z, as 0/12/3/-7; LOD 0 is the finest; Y does not matter to .height")
      ->required();
  get->add_option("-o,--output", arguments.get.output, "file; its extension is the format")->required();
  add_server(*get, arguments.get.server);
  CLI::Option* local = get->add_flag("--local", arguments.get.is_local, "evaluate here, without a server");
  get->add_option("--manifest", arguments.get.manifest, "with --local: TOML of the world; else the default world")
      ->needs(local);
  get->callback([&arguments] { arguments.command = [&arguments] { return cli::get(arguments.get); }; });
}

void add_info(CLI::App& app, Arguments& arguments) {
  CLI::App* info = app.add_subcommand("info", "Say what a server's world is");
  add_server(*info, arguments.info.server);
  info->add_flag("--json", arguments.info.is_json, "the whole manifest as JSON");
  info->callback([&arguments] { arguments.command = [&arguments] { return cli::info(arguments.info); }; });
}

void add_fly(CLI::App& app, Arguments& arguments) {
  FlyOptions& options = arguments.fly;
  CLI::App* fly = app.add_subcommand("fly", "Headless viewers that follow a path; says what arrived and when");
  add_server(*fly, options.server);
  fly->add_option("--from", options.from, "x,y,z in metres; else a standing place near the origin");
  fly->add_option("--to", options.to, "x,y,z in metres; else the viewer stays");
  fly->add_option("--speed", options.speed, "metres per second")->capture_default_str()->check(CLI::Range(0.0, 1000.0));
  fly->add_option("--seconds", options.seconds, "how long at most")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 86400.0));
  fly->add_option("--viewers", options.viewers, "viewers at once, 300 m apart, in this one process")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  fly->add_option("--near", options.near_m, "metres that LOD 0 reaches")->capture_default_str();
  fly->add_option("--far", options.far_m, "metres that anything reaches")->capture_default_str();
  fly->add_option("--lod-bias", options.lod_bias, "+1: every ring half as wide")->capture_default_str();
  fly->add_option("--credit", options.credit_bytes, "bytes a viewer takes ahead")->capture_default_str();
  fly->add_flag("--until-complete", options.until_complete, "end as soon as every viewer's view is complete");
  fly->add_flag("--decode", options.decodes, "decode every mesh, as a real viewer does");
  fly->add_flag("--json", options.is_json, "the summary as one line of JSON; progress goes to standard error");
  fly->callback([&arguments] { arguments.command = [&arguments] { return cli::fly(arguments.fly); }; });
}

void add_load(CLI::App& app, Arguments& arguments) {
  LoadOptions& options = arguments.load;
  CLI::App* load =
      app.add_subcommand("load", "Many clients at once: latencies, throughput, and whether all they got is right");
  load->add_option("scenario", options.scenario, "TOML file, as those in client_sample/load/scenarios");
  add_server(*load, options.server);
  load->add_option("--tcp", options.tcp, "where clients over TCP connect")->capture_default_str();
  load->add_option("--metrics", options.metrics,
                   "the server's admin door, as http://127.0.0.1:9090: its own counters beside ours");
  load->add_option("--seconds", options.seconds, "how long; else the scenario's, or 30")
      ->check(CLI::Range(0.1, 86400.0));
  for (std::size_t i = 0; i < load::kBotKinds; ++i) {
    const std::string name(load::name_of(static_cast<load::BotKind>(i)));
    load->add_option("--" + name, options.counts[i], "how many of the kind")->check(CLI::Range(0, 10000));
  }
  load->add_flag("--json", options.is_json, "the report as one line of JSON; progress goes to standard error");
  load->callback([&arguments] { arguments.command = [&arguments] { return cli::load(arguments.load); }; });
}

void add_pregen(CLI::App& app, Arguments& arguments) {
  PregenOptions& options = arguments.pregen;
  CLI::App* pregen = app.add_subcommand("pregen", "Make a server fill its disk cache with a square of a world");
  add_server(*pregen, options.server);
  pregen->add_option("--area", options.area, "x,z,km: centre in metres, edge in kilometres")->required();
  pregen->add_option("--lod-low", options.lod_low, "finest LOD")->capture_default_str()->check(CLI::Range(0, kLodMax));
  pregen->add_option("--lod-high", options.lod_high, "coarsest LOD")
      ->capture_default_str()
      ->check(CLI::Range(0, kLodMax));
  pregen->add_option("--progress", options.progress,
                     "file that remembers how far it is: run again to go on from there");
  pregen->add_option("--seconds", options.seconds, "how long at most")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 31536000.0));
  pregen->callback([&arguments] { arguments.command = [&arguments] { return cli::pregen(arguments.pregen); }; });
}

std::vector<std::string> layer_names() {
  return {kMapLayerNames.begin(), kMapLayerNames.end()};
}

void add_map(CLI::App& app, Arguments& arguments) {
  MapOptions& options = arguments.map;
  CLI::App* map = app.add_subcommand("map", "Draw a square of a world from above as a PNG; no server needed");
  map->add_option("--world", options.manifest, "TOML file of the world; else the default world");
  map->add_option("--area", options.area, "x,z,km: centre in metres, edge in kilometres")->required();
  map->add_option("--size", options.size, "pixels along each edge")->capture_default_str()->check(CLI::Range(16, 8192));
  map->add_option("--layer", options.layer, "what to show")->capture_default_str()->check(CLI::IsMember(layer_names()));
  map->add_option("--contours", options.contour_m, "metres between contour lines; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  map->add_option("-o,--output", options.output, "PNG file")->required();
  map->callback([&arguments] { arguments.command = [&arguments] { return cli::map(arguments.map); }; });
}

void add_section(CLI::App& app, Arguments& arguments) {
  SectionOptions& options = arguments.section;
  CLI::App* section =
      app.add_subcommand("section", "Draw a vertical cut through a world as a PNG: rock, caves, sea, sky");
  section->add_option("--world", options.manifest, "TOML file of the world; else the default world");
  section->add_option("--from", options.from, "x,z in metres: the left edge")->required();
  section->add_option("--to", options.to, "x,z in metres: the right edge")->required();
  section->add_option("--size", options.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  section->add_option("--heights", options.heights, "low,high in metres; else what the ground needs");
  section->add_option("-o,--output", options.output, "PNG file")->required();
  section->callback([&arguments] { arguments.command = [&arguments] { return cli::section(arguments.section); }; });
}

void add_view(CLI::App& app, Arguments& arguments) {
  ViewOptions& options = arguments.view;
  CLI::App* view = app.add_subcommand("view", "Draw a cliff with its caves and arches, up to 200 m wide, as a PNG");
  view->add_option("--world", options.manifest, "TOML file of the world; else the default world");
  view->add_option("--at", options.at, "x,y,z in metres: the middle of the picture")->required();
  view->add_option("--yaw", options.yaw, "degrees; 0 looks along -z (north), grows to the left")
      ->capture_default_str()
      ->check(CLI::Range(-360.0, 360.0));
  view->add_option("--pitch", options.pitch, "degrees, below 0 looks down")
      ->capture_default_str()
      ->check(CLI::Range(-89.0, 30.0));
  view->add_option("--width", options.width_m, "metres across the picture")
      ->capture_default_str()
      ->check(CLI::Range(10.0, 200.0));
  view->add_option("--size", options.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  view->add_option("-o,--output", options.output, "PNG file")->required();
  view->callback([&arguments] { arguments.command = [&arguments] { return cli::view(arguments.view); }; });
}

void add_survey(CLI::App& app, Arguments& arguments) {
  SurveyOptions& options = arguments.survey;
  CLI::App* survey = app.add_subcommand("survey", "Figures of a square of a world, and places worth a visit");
  survey->add_option("--world", options.manifest, "TOML file of the world; else the default world");
  survey->add_option("--area", options.area, "x,z,km: centre in metres, edge in kilometres")->capture_default_str();
  survey->add_option("--coast", options.coast_blocks, "blocks of 192 m of shore to look into for arches and caves")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096));
  survey->add_flag("--json", options.is_json, "one JSON object instead of a table");
  survey->callback([&arguments] { arguments.command = [&arguments] { return cli::survey(arguments.survey); }; });
}

void add_gallery(CLI::App& app, Arguments& arguments) {
  GalleryOptions& options = arguments.gallery;
  CLI::App* gallery = app.add_subcommand("gallery", "Draw side by side what single parameters do");
  gallery->add_option("folder", options.folder, "where the PNG files go")->required();
  gallery->add_option("--worlds", options.worlds, "folder of TOML files, to show side by side as well");
  gallery->add_option("--only", options.only, "one picture, by the name of its file (octaves, warp, carving ...)");
  gallery->add_option("--size", options.size, "pixels along each edge of one picture")
      ->capture_default_str()
      ->check(CLI::Range(64, 1024));
  gallery->callback([&arguments] { arguments.command = [&arguments] { return cli::gallery(arguments.gallery); }; });
}

void add_token(CLI::App& app, Arguments& arguments) {
  TokenOptions& options = arguments.token;
  CLI::App* token = app.add_subcommand("token", "Make a join token for a server with --token-keys, or a key for one");
  token->add_option("key", options.key_file, "file of the key, the server's own")->required();
  token->add_flag("--make-key", options.makes_key, "write a new key there instead");
  token->add_option("--world", options.world, "the world it opens")->capture_default_str();
  token->add_option("--hours", options.hours, "how long it opens it")
      ->capture_default_str()
      ->check(CLI::Range(1.0 / 3600.0, 24.0 * 3660.0));
  token->add_option("--subject", options.subject, "whom it is made for");
  token->callback([&arguments] { arguments.command = [&arguments] { return cli::token(arguments.token); }; });
}

void add_manifest(CLI::App& app, Arguments& arguments) {
  CLI::App* manifest = app.add_subcommand("manifest", "Check, explain or compare the TOML files of worlds");
  manifest->require_subcommand(1);
  CLI::App* check = manifest->add_subcommand("check", "Report every fault with its line, or the world's hash");
  check->add_option("file", arguments.checked, "TOML file")->required();
  check->callback([&arguments] { arguments.command = [&arguments] { return manifest_check(arguments.checked); }; });
  CLI::App* explain = manifest->add_subcommand("explain", "Print parameters with unit, limits, default and meaning");
  explain->add_option("name", arguments.explain.name, "a parameter as erosion.gain, or a section; else all");
  explain->add_option("--world", arguments.explain.manifest, "TOML file whose values to print; else the defaults");
  explain->callback([&arguments] { arguments.command = [&arguments] { return manifest_explain(arguments.explain); }; });
  CLI::App* diff = manifest->add_subcommand("diff", "Print what two worlds differ in");
  diff->add_option("from", arguments.from, "TOML file")->required();
  diff->add_option("to", arguments.to, "TOML file")->required();
  diff->callback(
      [&arguments] { arguments.command = [&arguments] { return manifest_diff(arguments.from, arguments.to); }; });
}

}  // namespace

int run(int argc, char** argv) {
  CLI::App app("talus: chunks, facts and headless viewers of a talus world", "talus");
  app.footer(kFooter);
  app.set_version_flag("--version", TALUS_VERSION);
  app.require_subcommand(1);
  Arguments arguments;
  add_get(app, arguments);
  add_info(app, arguments);
  add_fly(app, arguments);
  add_load(app, arguments);
  add_pregen(app, arguments);
  add_map(app, arguments);
  add_section(app, arguments);
  add_view(app, arguments);
  add_survey(app, arguments);
  add_gallery(app, arguments);
  add_manifest(app, arguments);
  add_token(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  return arguments.command();
}

}  // namespace talus::cli
