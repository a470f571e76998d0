// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace handcast {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string suggest(std::string_view wrong, const std::vector<std::string_view>& known) {
  constexpr std::size_t kLongestName = 100;  // the distance takes the product of the lengths
  if (wrong.size() > kLongestName) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(2, wrong.size() / 3) + 1;
  for (const auto name : known) {
    const auto distance = edit_distance(wrong, name);
    if (distance < best_distance && distance < name.size())
      std::tie(best, best_distance) = std::tuple(name, distance);
  }
  return best.empty() ? "" : fmt::format(" (did you mean '{}'?)", best);
}

}  // namespace handcast
