// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "services/landmarks/crop/crop.hpp"
#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/models/handcast_network.hpp"
#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::landmarks {

/// handcast's own landmark network. Reads the image and, if there is one, the tracker's joints; its
/// points are the tracker's joints.
class HandcastModel final : public LandmarkModel {
 public:
  /// Errors (bad_config): `file` contains another network, or those of open_network().
  static Result<HandcastModel> open(const std::filesystem::path& file);

  Traits traits() const override { return {.passes_at_first = 2, .reads_tracker = true}; }
  Region region_around(const Points& points_px) const override {
    return handcast_network::region_around(points_px);
  }
  /// See LandmarkModel. Reads `side` and `tracker_px`.
  Result<LandmarkEstimate> estimate(renderer::GreyView image, const Region& region, msg::Side side,
                                    const std::optional<Points>& tracker_px,
                                    EstimateTimes& times) override;

 private:
  explicit HandcastModel(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  std::unique_ptr<Network> network_;
  Crop crop_{handcast_network::kSide_px};
};

/// The network file that comes with handcast: landmarks/handcast.onnx in the folder of the assets
/// (HANDCAST_ASSETS, or share/handcast of the build or the installation).
std::filesystem::path shipped_network_file();

/// The row `handcast` of the table. Opens MediaPipe's palm network, too, if options.folder has it.
Result<OpenedModel> open_handcast_model(const ModelOptions& options);
/// The file that it needs.
std::vector<std::filesystem::path> handcast_files(const ModelOptions& options);

}  // namespace handcast::landmarks
