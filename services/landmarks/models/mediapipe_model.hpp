// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "services/landmarks/crop/crop.hpp"
#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::landmarks {

/// MediaPipe Hands' landmark network (lite). Reads the image alone; reports no sigmas.
class MediapipeModel final : public LandmarkModel {
 public:
  /// `file`: of the landmark network. Errors: those of open_mediapipe_network().
  static Result<MediapipeModel> open(const std::filesystem::path& file);

  /// The sigma makes the light nearest to its place on the twin (docs/lab/experiments.md).
  Traits traits() const override {
    return {.passes_at_first = 1, .scores_sides = true, .usual_sigma = 0.045f};
  }
  Region region_around(const Points& points_px) const override;
  /// Ignores `side` and `tracker_px`.
  Result<LandmarkEstimate> estimate(renderer::GreyView image, const Region& region, msg::Side side,
                                    const std::optional<Points>& tracker_px,
                                    EstimateTimes& times) override;

 private:
  explicit MediapipeModel(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  static constexpr int kSide_px = 224;
  std::unique_ptr<Network> network_;
  Crop crop_{kSide_px};
};

/// The row `mediapipe` of the table: landmark network and palm network from options.folder.
Result<OpenedModel> open_mediapipe_model(const ModelOptions& options);
/// The files that it needs.
std::vector<std::filesystem::path> mediapipe_files(const ModelOptions& options);

}  // namespace handcast::landmarks
