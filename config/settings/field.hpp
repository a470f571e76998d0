// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string_view>

namespace handcast::config {

/// What a number may be, and its unit ("" where it has none). Shown in every message about it and
/// in REFERENCE.md.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string_view unit;
};

constexpr Range between(double min, double max, std::string_view unit = "") {
  return {min, max, unit};
}
constexpr Range at_least(double min, std::string_view unit = "") {
  return {min, std::numeric_limits<double>::infinity(), unit};
}

/// A visitor over the settings of a struct. A settings struct `X` is declared once, by a free
/// function
///
///     template <class Visitor> void describe(Visitor& visitor, X& x) {
///       visitor.field("rate_hz", x.rate_hz, between(1, 2000, "Hz"),
///                     "Frames a second asked of the camera.");
///       visitor.section("replay", x.replay, "Frames from a folder instead of a camera.");
///     }
///
/// The loader, the printer (commented TOML), `--set path=value` and REFERENCE.md are visitors; the
/// default of a setting is what the struct is born with. Field types: bool, int, double,
/// std::string, std::vector<double>, and enums with words (choice.hpp). `section` calls describe()
/// of the member, found by argument-dependent lookup.

}  // namespace handcast::config
