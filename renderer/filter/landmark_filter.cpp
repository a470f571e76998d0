// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_filter.hpp"

#include <algorithm>

#include "renderer/filter/filters.hpp"

namespace handcast::renderer {
namespace {

using config::FilterMethod;

class NoFilter final : public LandmarkFilter {
 public:
  void detection(std::int64_t, std::int64_t, const msg::HandLandmarks&, const TrackerAt&) override {
  }
  void tracker_sample(std::int64_t) override {}
  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t, const LandmarkPoints&) override {
    return std::nullopt;
  }
};

/// The true landmarks: a lower bound for the error of every filter.
class IdealFilter final : public LandmarkFilter {
 public:
  explicit IdealFilter(LandmarkOracle oracle) : oracle_(std::move(oracle)) {}
  void detection(std::int64_t, std::int64_t, const msg::HandLandmarks&, const TrackerAt&) override {
  }
  void tracker_sample(std::int64_t) override {}
  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns,
                                   const LandmarkPoints&) override {
    return oracle_(target_ns);
  }

 private:
  LandmarkOracle oracle_;
};

/// Sets the unknown offsets to the mean of the known ones. Does nothing if none is known.
void lend_offsets(std::array<glm::vec2, kLandmarks>& offsets,
                  const std::array<bool, kLandmarks>& known) {
  glm::vec2 sum{0};
  int count = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    if (!known[i]) continue;
    sum += offsets[i];
    ++count;
  }
  for (int i = 0; i < kLandmarks && count > 0; ++i)
    if (!known[i]) offsets[i] = sum / static_cast<float>(count);
}

}  // namespace

std::optional<LandmarkPoints> moved_by(const LandmarkPoints& tracker,
                                       std::array<glm::vec2, kLandmarks> offsets,
                                       const std::array<bool, kLandmarks>& known) {
  if (std::ranges::find(known, true) == known.end()) return std::nullopt;
  lend_offsets(offsets, known);
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = tracker[i] + offsets[i];
  return points;
}

bool moves_with_tracker(const config::Filter& settings) {
  switch (settings.method) {
    case FilterMethod::paper:
    case FilterMethod::articulated:
      return true;
    default:
      return false;
  }
}

std::unique_ptr<LandmarkFilter> make_landmark_filter(const config::Filter& settings,
                                                     LandmarkOracle oracle) {
  switch (settings.method) {
    case FilterMethod::none:
      break;
    case FilterMethod::naive:
      return make_settled_filter(settings, make_naive_filter());
    case FilterMethod::paper:
      return make_settled_filter(settings, make_paper_filter());
    case FilterMethod::kalman:
    case FilterMethod::articulated:  // as long as the tracker's errors are not known
      return make_settled_filter(settings, make_kalman_filter(settings));
    case FilterMethod::ideal:
      if (oracle) return std::make_unique<IdealFilter>(std::move(oracle));
  }
  return std::make_unique<NoFilter>();
}

}  // namespace handcast::renderer
