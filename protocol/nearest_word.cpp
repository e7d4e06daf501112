// The known word that a mistyped one is nearest to.
#include <algorithm>
#include <array>
#include <utility>

#include "protocol/toml_reader.hpp"

namespace talus::protocol {
namespace {

constexpr std::size_t kWordMax = 64;

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`. Both at most kWordMax.
/// Based on: F. J. Damerau, "A technique for computer detection and correction of spelling errors", 1964 (optimal
/// string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::array<std::array<std::size_t, kWordMax + 1>, 3> rows{};
  auto* before = &rows[0];
  auto* above = &rows[1];
  auto* row = &rows[2];
  for (std::size_t j = 0; j <= b.size(); ++j) (*above)[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    (*row)[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = (*above)[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      (*row)[j] = std::min({(*above)[j] + 1, (*row)[j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) (*row)[j] = std::min((*row)[j], (*before)[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return (*above)[b.size()];
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
  if (word.size() > kWordMax) return {};
  std::string_view nearest;
  // Beyond a third of its letters a suggestion confuses more than it helps.
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > kWordMax) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace talus::protocol
