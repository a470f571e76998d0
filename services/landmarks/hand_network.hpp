#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/landmarks/crop.hpp"
#include "services/landmarks/network/network.hpp"
#include "services/landmarks/palm.hpp"

namespace handcast::landmarks {

/// MediaPipe Hands' landmark network (lite): one hand in an upright region.
class HandNetwork {
 public:
  /// Errors (bad_config): as of open_network, and a file that holds another network.
  static Result<HandNetwork> open(const std::string& backend, const std::filesystem::path& folder);

  struct Seen {
    Points points_px{};    ///< in the image
    float presence = 0;    ///< 0..1: that there is a hand
    float left_score = 0;  ///< 0..1: that it is a left one, in an image that is not mirrored
  };
  /// Times in ns on top of what they are. Errors: bad_data.
  struct Times {
    std::int64_t crop_ns = 0, network_ns = 0;
  };
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
