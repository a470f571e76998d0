// SPDX-License-Identifier: Apache-2.0
#include "config/keep_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "ipc/base/quote.hpp"

namespace handcast::config {
namespace {

constexpr std::size_t kMostAreas = 16, kFewestCorners = 3, kMostCorners = 32;
constexpr double kFarthest_px = 1e5;

/// Takes a number off the front of a text; empty if there is none.
std::optional<double> take_number(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  double number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc() || !(std::abs(number) <= kFarthest_px)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// Empty if the text is no polygon.
std::optional<Polygon> parse_polygon(std::string_view text) {
  Polygon corners;
  for (;;) {
    const auto x = take_number(text), y = take_number(text);
    if (!x || !y || corners.size() == kMostCorners) return std::nullopt;
    corners.push_back({*x, *y});
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.empty()) break;
    if (text.front() != ',') return std::nullopt;
    text.remove_prefix(1);
  }
  if (corners.size() < kFewestCorners) return std::nullopt;
  return corners;
}

}  // namespace

Result<std::vector<Polygon>> parse_keep_out(std::span<const std::string> areas) {
  if (areas.size() > kMostAreas)
    return fail(Errc::bad_config,
                fmt::format("{} areas; at most {} are possible", areas.size(), kMostAreas));
  std::vector<Polygon> polygons;
  for (const auto& area : areas) {
    auto polygon = parse_polygon(area);
    if (!polygon)
      return fail(Errc::bad_config,
                  fmt::format("{} is not an area; write {} to {} corners in pixels, e.g. \"100 80, "
                              "300 80, 200 240\"",
                              quote(area), kFewestCorners, kMostCorners));
    polygons.push_back(std::move(*polygon));
  }
  return polygons;
}

}  // namespace handcast::config
