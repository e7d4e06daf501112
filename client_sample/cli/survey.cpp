// talus survey: figures of a world, as a table or as JSON.
#include <fmt/format.h>

#include "client_sample/cli/coast_search.hpp"
#include "client_sample/cli/commands.hpp"
#include "client_sample/cli/files.hpp"
#include "client_sample/cli/survey.hpp"
#include "client_sample/cli/text.hpp"

namespace talus::cli {
namespace {

double per_km(int count, double km) {
  return km > 0 ? count / km : 0;
}

void print_table(const Manifest& manifest, const SurveyGrid& grid, const SurveyFigures& f, const CoastFigures& c,
                 const std::vector<SurveyPlace>& places) {
  const auto line = [](std::string_view name, const std::string& value) { fmt::print("{:<22} {}\n", name, value); };
  line("world", fmt::format("{}, {:.0f} km square, a column each {:g} m", manifest.name,
                            grid.edge * grid.spacing_m / 1000, grid.spacing_m));
  line("land", fmt::format("{:.1f} %", f.land_share * 100));
  const auto& p = f.height_percentiles_m;
  line("heights",
       fmt::format("1 % {:.0f}, 5 % {:.0f}, 25 % {:.0f}, 50 % {:.0f}, 75 % {:.0f}, 95 % {:.0f}, 99 % {:.0f} m", p[0],
                   p[1], p[2], p[3], p[4], p[5], p[6]));
  line("modes", fmt::format("sea floor {:.0f} m, land {:.0f} m", f.sea_mode_m, f.land_mode_m));
  line("slope of land", fmt::format("50 % {:.2f}, 90 % {:.2f}, 99 % {:.2f} over {:g} m", f.slope_percentiles[0],
                                    f.slope_percentiles[1], f.slope_percentiles[2], 2 * grid.spacing_m));
  line("drainage", fmt::format("{:.2f} km a km2 at this spacing", f.drainage_km_per_km2));
  line("coast", fmt::format("{:.0f} km at this spacing, dimension {:.2f}", f.coast_km, f.coast_dimension));
  line("overhangs",
       fmt::format("{:.2f} % of land; {:.0f} columns a km of shore", f.overhang_share * 100, f.coast_overhangs_per_km));
  if (c.shore_km > 0) {
    line("shore, looked into", fmt::format("{:.1f} km, {:.0f} % of it cliffs, {:.1f} m2 under overhangs a metre of it",
                                           c.shore_km, c.cliff_share * 100, c.overhang_m2_per_m));
    const double cliff_km = c.shore_km * c.cliff_share;
    line("arches and caves", fmt::format("{} and {}: {:.2f} and {:.2f} a km of shore, {:.2f} and {:.2f} a km of cliffs",
                                         c.arches, c.caves, per_km(c.arches, c.shore_km), per_km(c.caves, c.shore_km),
                                         per_km(c.arches, cliff_km), per_km(c.caves, cliff_km)));
    line("loose rock", fmt::format("{} pieces, {:.2f} a km of shore, of {} m3 at most", c.loose,
                                   per_km(c.loose, c.shore_km), c.loose_m3));
  }
  for (int bin = 0; bin < kHypsometricBins; ++bin) {
    const double share = f.bin_shares[static_cast<std::size_t>(bin)];
    if (share < 5e-5) continue;
    fmt::print("{:>8.0f} m  {:5.2f} %  {:#<{}}\n", f.bin_low_m + bin * f.bin_m, share * 100, "",
               static_cast<int>(share * 150));
  }
  for (const SurveyPlace& place : places) {
    fmt::print("{:<14} x {:.0f}, z {:.0f}, {:.0f} m: {}\n", place.kind, place.place_m.x, place.place_m.z,
               place.place_m.y, place.why);
  }
}

template <typename Numbers>
std::string json_list(const Numbers& numbers) {
  return fmt::format("[{:.6g}]", fmt::join(numbers, ","));
}

void print_json(const Manifest& manifest, const SurveyGrid& grid, const SurveyFigures& f, const CoastFigures& c,
                const std::vector<SurveyPlace>& places) {
  fmt::print(R"({{"world":{},"seed":"{}","edge_km":{},"spacing_m":{},"land_share":{:.5f},"height_percentiles_m":{},)",
             json_string(manifest.name), manifest.seed, grid.edge * grid.spacing_m / 1000, grid.spacing_m, f.land_share,
             json_list(f.height_percentiles_m));
  fmt::print(R"("hypsometric":{{"low_m":{},"bin_m":{},"shares":{}}},"modes_m":[{},{}],"slope_percentiles":{},)",
             f.bin_low_m, f.bin_m, json_list(f.bin_shares), f.sea_mode_m, f.land_mode_m,
             json_list(f.slope_percentiles));
  fmt::print(
      R"("drainage_km_per_km2":{:.4f},"coast_km":{:.2f},"coast_dimension":{:.4f},"overhang_share":{:.5f},"coast_overhangs_per_km":{:.2f},)",
      f.drainage_km_per_km2, f.coast_km, f.coast_dimension, f.overhang_share, f.coast_overhangs_per_km);
  fmt::print(
      R"("shore_km":{:.3f},"cliff_share":{:.4f},"arches":{},"caves":{},"overhang_m2_per_m":{:.3f},"loose":{},"loose_m3":{},"places":[)",
      c.shore_km, c.cliff_share, c.arches, c.caves, c.overhang_m2_per_m, c.loose, c.loose_m3);
  std::string_view comma;
  for (const SurveyPlace& place : places) {
    fmt::print(R"({}{{"kind":{},"x":{},"y":{:.1f},"z":{},"why":{}}})", comma, json_string(place.kind), place.place_m.x,
               place.place_m.y, place.place_m.z, json_string(place.why));
    comma = ",";
  }
  fmt::print("]}}\n");
}

}  // namespace

ExitCode survey(const SurveyOptions& options) {
  const auto area = area_of(options.area);
  if (!area) return kUsage;
  const auto manifest = load_manifest(options.manifest);
  if (!manifest) return manifest.error();
  const WorldFunction world(*manifest);
  const SurveyGrid grid = survey_grid(world, *area);
  const SurveyFigures figures = survey_figures(world, grid);
  const CoastFigures coast = search_coast(world, grid, options.coast_blocks);
  std::vector<SurveyPlace> places = survey_places(world, grid);
  places.insert(places.end(), coast.places.begin(), coast.places.end());
  (options.is_json ? print_json : print_table)(*manifest, grid, figures, coast, places);
  return kDone;
}

}  // namespace talus::cli
