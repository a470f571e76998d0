#include "renderer/cascade/landmark_filter.hpp"

#include "renderer/cascade/filters/filters.hpp"

namespace handcast::renderer {
namespace {

class NoFilter final : public LandmarkFilter {
 public:
  void detection(std::int64_t, std::int64_t, const msg::HandLandmarks&, const TrackerAt&) override {}
  void tracker_sample(std::int64_t) override {}
  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t, const LandmarkPoints&) override { return std::nullopt; }
};

}  // namespace

std::unique_ptr<LandmarkFilter> make_landmark_filter(const config::Filter& settings) {
  if (settings.method == "naive") return make_settled_filter(settings, make_naive_filter());
  if (settings.method == "paper") return make_settled_filter(settings, make_paper_filter(settings));
  if (settings.method == "offset_kalman") return make_settled_filter(settings, make_offset_kalman(settings));
  return std::make_unique<NoFilter>();
}

}  // namespace handcast::renderer
