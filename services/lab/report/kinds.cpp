// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/kinds.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace handcast::report {
namespace {

using nlohmann::json;

enum class Kind {
  number,
  text,
  figures,  ///< an object of numbers
  tables,   ///< an object of figures
  groups    ///< an object of objects with other values
};

struct Place {
  std::string_view key;
  Kind kind;
};

/// The values of the files of simulate, observer and supervisor that the page shows.
constexpr std::array kPlaces{
    Place{"frames", Kind::number},       Place{"coverage", Kind::number},
    Place{"spill", Kind::number},        Place{"iou", Kind::number},
    Place{"seam_px", Kind::number},      Place{"jitter_px", Kind::number},
    Place{"missing", Kind::number},      Place{"residual_px", Kind::number},
    Place{"foldovers", Kind::number},    Place{"equivalent_latency_ms", Kind::number},
    Place{"software_ms", Kind::number},  Place{"seconds", Kind::number},
    Place{"seed", Kind::number},         Place{"rig", Kind::text},
    Place{"motion", Kind::text},         Place{"interior_mm", Kind::figures},
    Place{"interior_px", Kind::figures}, Place{"frame_us", Kind::figures},
    Place{"stage_us", Kind::tables},     Place{"rates", Kind::tables},
    Place{"bins", Kind::groups},         Place{"services", Kind::groups},
};

std::string wrong_kind(const json& value, Kind kind, const std::string& place) {
  if (value.is_null()) return {};
  if (kind == Kind::number) return value.is_number() ? "" : place + " must be a number";
  if (kind == Kind::text) return value.is_string() ? "" : place + " must be a text";
  if (!value.is_object()) return place + " must be an object";
  for (const auto& [name, member] : value.items()) {
    const auto inner = fmt::format("{}/{}", place, name);
    auto wrong = kind == Kind::figures                    ? wrong_kind(member, Kind::number, inner)
                 : kind == Kind::tables                   ? wrong_kind(member, Kind::figures, inner)
                 : member.is_object() || member.is_null() ? ""
                                                          : inner + " must be an object";
    if (!wrong.empty()) return wrong;
  }
  return {};
}

}  // namespace

std::string wrong_kind(const json& results) {
  for (const auto& [key, kind] : kPlaces)
    if (const auto found = results.find(key); found != results.end())
      if (auto wrong = wrong_kind(*found, kind, "/" + std::string(key)); !wrong.empty())
        return wrong;
  return {};
}

// Copying and printing JSON recurses.
json parse_shallow(const std::string& text) {
  constexpr int kMostDepth = 32;
  bool too_deep = false;
  auto parsed = json::parse(
      text,
      [&](int depth, json::parse_event_t, json&) {
        too_deep |= depth > kMostDepth;
        return !too_deep;
      },
      /*allow_exceptions=*/false);
  return too_deep ? json(json::value_t::discarded) : parsed;
}

}  // namespace handcast::report
