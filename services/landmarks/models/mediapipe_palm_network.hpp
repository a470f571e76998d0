// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "renderer/base/image.hpp"
#include "services/landmarks/crop/crop.hpp"
#include "services/landmarks/inference/network.hpp"
#include "services/landmarks/models/mediapipe_palms.hpp"

namespace handcast::landmarks {

/// MediaPipe Hands' palm network (lite), which searches a whole image for palms. One thread.
class MediapipePalmNetwork {
 public:
  /// Errors: those of open_mediapipe_network().
  static Result<MediapipePalmNetwork> open(const std::filesystem::path& file);

  /// The regions of the palms in the image, the most certain first. Errors: bad_data.
  Result<std::vector<Region>> search(renderer::GreyView image);

 private:
  explicit MediapipePalmNetwork(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  std::unique_ptr<Network> network_;
  Crop crop_{kPalmSide_px};
};

}  // namespace handcast::landmarks
