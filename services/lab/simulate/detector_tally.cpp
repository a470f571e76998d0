// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/detector_tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
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

void DetectorTally::add(const Exposure& exposure, const Detection& detection) {
  ++runs_;
  if (detection.work_ns > 0) work_ms_.add(ns_to_ms(detection.work_ns));
  for (const auto side : {msg::Side::left, msg::Side::right})
    add_hand(side, exposure.origin_ns,
             detection.landmarks ? detection.landmarks->find(side) : nullptr);
}

void DetectorTally::add_hand(msg::Side side, std::int64_t time_ns,
                             const msg::HandLandmarks* found) {
  const auto truth = twin_.landmarks(side, time_ns);
  if (!truth) {
    invented_ += found != nullptr;
    return;
  }
  const auto seen =
      std::ranges::count_if(*truth, [this](glm::vec2 point) { return in_image(point); });
  if (2 * seen < msg::kLandmarks) return;
  ++hands_;
  missed_ += found == nullptr;
  if (!found) return;
  ErrorMemory::Errors errors;
  errors.fill(glm::vec2(std::numeric_limits<float>::quiet_NaN()));
  for (std::size_t i = 0; i < truth->size(); ++i)
    if (in_image((*truth)[i])) {
      errors[i] = glm::vec2(found->points[i].x_px, found->points[i].y_px) - (*truth)[i];
      error_px_.add(glm::length(errors[i]));
    }
  memory_.add(side, time_ns, errors);
}

bool DetectorTally::in_image(glm::vec2 undistorted_px) const {
  return camera_.contains(camera_.distort(undistorted_px));
}

nlohmann::json DetectorTally::to_json() const {
  return {{"runs", runs_},
          {"hands", hands_},
          {"missed", missed_},
          {"invented", invented_},
          {"error_px",
           {{"mean", error_px_.mean()},
            {"p50", error_px_.percentile(0.5)},
            {"p95", error_px_.percentile(0.95)},
            {"autocorrelation", memory_.to_json()}}},
          {"ms_p50", work_ms_.percentile(0.5)}};
}

void DetectorTally::Histogram::add(double value) {
  const auto bin = static_cast<std::size_t>(
      std::clamp(value * kSteps, 0.0, static_cast<double>(counts_.size() - 1)));
  ++counts_[bin];
  ++count_;
  sum_ += value;
}

nlohmann::json DetectorTally::Histogram::mean() const {
  return count_ > 0 ? nlohmann::json(sum_ / static_cast<double>(count_)) : nlohmann::json();
}

nlohmann::json DetectorTally::Histogram::percentile(double share) const {
  if (count_ == 0) return {};
  std::size_t bin = 0, below = counts_[0];
  while (static_cast<double>(below) < share * static_cast<double>(count_)) below += counts_[++bin];
  return static_cast<double>(2 * bin + 1) / kSteps / 2;
}

}  // namespace handcast::simulate
