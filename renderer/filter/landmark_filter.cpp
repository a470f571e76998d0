// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_filter.hpp"

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

}  // namespace

bool moves_with_tracker(const config::Filter& settings) {
  switch (settings.method) {
    case FilterMethod::paper:
    case FilterMethod::one_euro:
    case FilterMethod::offset_kalman:
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
      return make_settled_filter(settings, make_paper_filter(settings));
    case FilterMethod::kalman:
      return make_settled_filter(settings, make_kalman_filter(settings));
    case FilterMethod::one_euro:
      return make_settled_filter(settings, make_one_euro_filter(settings));
    case FilterMethod::offset_kalman:
      return make_settled_filter(settings, make_offset_kalman(settings));
    case FilterMethod::ideal:
      if (oracle) return std::make_unique<IdealFilter>(std::move(oracle));
  }
  return std::make_unique<NoFilter>();
}

}  // namespace handcast::renderer
