// What the program can do; each returns an exit code and has said on standard error why it is not kDone.
#pragma once

#include <array>
#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "client_sample/cli/exit_code.hpp"
#include "client_sample/load/scenario.hpp"
#include "core/grid/chunk_key.hpp"

namespace talus::cli {

struct ServerOptions {
  std::string url = "http://127.0.0.1:8080";
  std::string world = "default";
  std::string ca_file;  ///< PEM of the authorities to trust; empty: the system's
  std::string token;    ///< for servers that ask for one
};

struct GetOptions {
  ServerOptions server;
  std::string key;        ///< LOD/X/Y/Z
  std::string output;     ///< its extension is the format
  bool is_local = false;  ///< evaluate in this process, without a server
  std::string manifest;   ///< of a local world; empty: the default world
};
ExitCode get(const GetOptions& options);

struct InfoOptions {
  ServerOptions server;
  bool is_json = false;
};
ExitCode info(const InfoOptions& options);

struct FlyOptions {
  ServerOptions server;
  std::string from;     ///< x,y,z; empty: a standing place near the origin
  std::string to;       ///< x,y,z; empty: stays
  double speed = 20.0;  ///< metres per second
  double seconds = 10.0;
  int viewers = 1;
  double near_m = 128.0;
  double far_m = 2000.0;
  double lod_bias = 0.0;
  std::uint64_t credit_bytes = 4ULL * 1024 * 1024;
  bool until_complete = false;  ///< ends as soon as every viewer's view is complete
  bool decodes = false;         ///< decodes every mesh, as a real viewer does
  bool is_json = false;
};
ExitCode fly(const FlyOptions& options);

struct LoadOptions {
  ServerOptions server;
  std::string tcp = "tcp://127.0.0.1:8081";
  std::string metrics;   ///< URL of the admin door; empty: the server is not asked what it counted
  std::string scenario;  ///< TOML file; empty: only what `counts` says
  std::array<int, load::kBotKinds> counts = [] {
    std::array<int, load::kBotKinds> out{};
    out.fill(-1);
    return out;
  }();                 ///< bots of each kind; below 0: as the scenario says
  double seconds = 0;  ///< 0: as the scenario says
  bool is_json = false;
};
/// Many clients at once; kIncomplete if anything was wrong with what they got.
ExitCode load(const LoadOptions& options);

struct PregenOptions {
  ServerOptions server;
  std::string area;  ///< x,z of the centre in metres and the edge in km
  int lod_low = 0;
  int lod_high = 8;
  std::string progress;  ///< file to go on from; empty: none
  double seconds = 86400;
};
/// Makes a server fill its caches with a square; kIncomplete if the time was up before.
ExitCode pregen(const PregenOptions& options);

struct MapOptions {
  std::string manifest;  ///< file; empty: the default world
  std::string area;      ///< x,z of the centre in metres and the edge in km
  int size = 1024;       ///< pixels along each edge
  std::string layer = "shaded";
  double contour_m = 0;
  std::string output;
};
ExitCode map(const MapOptions& options);

struct SectionOptions {
  std::string manifest;  ///< file; empty: the default world
  std::string from;      ///< x,z in metres
  std::string to;
  std::string size = "1600x600";
  std::string heights;  ///< low,high in metres; empty: what the ground needs
  std::string output;
};
ExitCode section(const SectionOptions& options);

struct ViewOptions {
  std::string manifest;  ///< file; empty: the default world
  std::string at;        ///< x,y,z in metres: the middle of the picture
  double yaw = 0;        ///< degrees; 0 looks along -z, grows to the left
  double pitch = -14;    ///< degrees, below 0 looks down
  double width_m = 150;
  std::string size = "960x640";
  std::string output;
};
/// Draws a cliff as it is, caves and arches included, without a server.
ExitCode view(const ViewOptions& options);

struct SurveyOptions {
  std::string manifest;  ///< file; empty: the default world
  std::string area = "0,0,256";
  int coast_blocks = 64;  ///< of 192 m, looked into for arches and caves
  bool is_json = false;
};
/// Prints figures of a square of a world, and places in it that are worth a visit.
ExitCode survey(const SurveyOptions& options);

struct GalleryOptions {
  std::string folder;
  std::string worlds;  ///< folder of TOML files, drawn side by side as well; empty: none
  std::string only;    ///< the file of one parameter, without its ending; empty: all
  int size = 200;      ///< pixels along each edge of one picture
};
/// Draws side by side what single parameters do: one PNG a parameter.
ExitCode gallery(const GalleryOptions& options);

struct TokenOptions {
  std::string key_file;
  bool makes_key = false;  ///< writes a new key to `key_file`, and no token
  std::string world = "default";
  double hours = 24.0;
  std::string subject;  ///< whom it is made for
};
/// Prints a token that opens a world of a server with the same key.
ExitCode token(const TokenOptions& options);

ExitCode manifest_check(const std::string& file);

struct ExplainOptions {
  std::string name;      ///< a parameter, a section, or empty: all
  std::string manifest;  ///< whose values to show; empty: the default world
};
/// Prints parameters as a TOML file: unit, limits, default and what more and less of each does.
ExitCode manifest_explain(const ExplainOptions& options);
/// Prints what two worlds differ in, one line a key.
ExitCode manifest_diff(const std::string& from, const std::string& to);

}  // namespace talus::cli
