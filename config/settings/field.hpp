// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <string_view>

namespace handcast::config {

/// The range and unit of a number, shown in messages and in REFERENCE.md.
struct Range {
  /// The smallest and largest allowed value, both included.
  /// @{
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  /// @}
  std::string_view unit;  ///< e.g. "ms"; empty if the number has no unit
};

/// The range `min` .. `max`, or from `min` without an upper limit.
/// @{
constexpr Range between(double min, double max, std::string_view unit = "") {
  return {min, max, unit};
}
constexpr Range at_least(double min, std::string_view unit = "") {
  return {min, std::numeric_limits<double>::infinity(), unit};
}
/// @}

/// When a change of a setting takes effect.
enum class Effect {
  restart,  ///< when its services are started again
  live,     ///< at once, in all processes that read it
};

// How settings are declared. The settings of a struct `X` are declared once, by a free function:
//
//     template <class Visitor> void describe(Visitor& visitor, X& x) {
//       visitor.field("rate_hz", x.rate_hz, between(1, 2000, "Hz"),
//                     "Frames per second requested from the camera.");
//       visitor.section("replay", x.replay, "Frames from a folder instead of a camera.");
//     }
//
// A setting whose declaration ends with Effect::live can be changed while the rig is up (`handcast
// set`). Of a section it is said of all settings in it that do not say otherwise.
//
// Collector (settings.hpp) is the visitor. The loader, the printer (commented TOML), `--set
// path=value` and REFERENCE.md use the listing that it makes. The default of a setting is the
// initial value of its member. Types of fields: bool, int, double, std::string,
// std::vector<double>, std::vector<std::string>, and enums with words (choice.hpp). section() calls
// describe() of the member, found by argument-dependent lookup.

}  // namespace handcast::config
