// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/error_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::simulate {
namespace {

constexpr std::array<int, 4> kDelays_ms{50, 100, 200, 400};
/// How far the time between two detections may be from a delay.
constexpr std::int64_t kTolerance_ns = 12'000'000;

struct Sums {
  double product = 0, square = 0;
};

void add_pair(const ErrorMemory::Errors& a, const ErrorMemory::Errors& b, Sums& sums) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i].x) || std::isnan(b[i].x)) continue;
    sums.product += glm::dot(a[i], b[i]);
    sums.square += (glm::dot(a[i], a[i]) + glm::dot(b[i], b[i])) / 2;
  }
}

}  // namespace

void ErrorMemory::add(msg::Side side, std::int64_t time_ns, const Errors& errors) {
  entries_[static_cast<std::size_t>(side)].push_back({time_ns, errors});
}

nlohmann::json ErrorMemory::to_json() const {
  nlohmann::json json;
  for (const int delay_ms : kDelays_ms) {
    Sums sums;
    for (const auto& entries : entries_)
      for (const auto& entry : entries) {
        const auto wanted_ns = entry.time_ns + ms_to_ns(delay_ms);
        const auto later = std::ranges::min_element(
            std::ranges::lower_bound(entries, wanted_ns - kTolerance_ns, {}, &Entry::time_ns),
            std::ranges::upper_bound(entries, wanted_ns + kTolerance_ns, {}, &Entry::time_ns), {},
            [&](const Entry& other) { return std::abs(other.time_ns - wanted_ns); });
        if (later != entries.end() && std::abs(later->time_ns - wanted_ns) <= kTolerance_ns)
          add_pair(entry.errors, later->errors, sums);
      }
    json[fmt::format("{}", delay_ms)] =
        sums.square > 0 ? nlohmann::json(sums.product / sums.square) : nlohmann::json();
  }
  return json;
}

}  // namespace handcast::simulate
