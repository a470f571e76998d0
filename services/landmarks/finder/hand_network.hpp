// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/landmarks/finder/crop.hpp"
#include "services/landmarks/finder/landmark_model.hpp"
#include "services/landmarks/finder/palm.hpp"
#include "services/landmarks/inference/network.hpp"

namespace handcast::landmarks {

/// MediaPipe Hands' landmark network (lite): one hand in an upright region.
class HandNetwork final : public LandmarkModel {
 public:
  /// Errors (bad_config): as of open_network, and a file that holds another network.
  static Result<HandNetwork> open(const std::string& backend, const std::filesystem::path& folder);

  Region region_around(const Points& points_px) const override {
    return region_of_landmarks(points_px);
  }
  int first_looks() const override { return 1; }
  bool tells_sides() const override { return true; }
  /// It knows no tracker.
  Result<Seen> look(renderer::GreyView image, const Region& region, msg::Side,
                    const std::optional<Points>&, Times& times) override {
    return look(image, region, times);
  }
  Result<Seen> look(renderer::GreyView image, const Region& region, Times& times);

 private:
  explicit HandNetwork(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  static constexpr int kSide_px = 224;
  std::unique_ptr<Network> network_;
  Crop crop_{kSide_px};
};

/// MediaPipe Hands' palm network (lite): where in the whole image are palms?
class PalmNetwork {
 public:
  /// Errors: as above.
  static Result<PalmNetwork> open(const std::string& backend, const std::filesystem::path& folder);

  /// Regions to look for landmarks in, the surest first. Errors: bad_data.
  Result<std::vector<Region>> search(renderer::GreyView image);

 private:
  explicit PalmNetwork(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  std::unique_ptr<Network> network_;
  Crop crop_{kPalmSide_px};
};

}  // namespace handcast::landmarks
