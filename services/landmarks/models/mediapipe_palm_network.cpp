// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_palm_network.hpp"

#include "services/landmarks/models/mediapipe_files.hpp"

namespace handcast::landmarks {

Result<MediapipePalmNetwork> MediapipePalmNetwork::open(const std::filesystem::path& file) {
  static const NetworkShapes kShapes{"the palm network",
                                     {1, kPalmSide_px, kPalmSide_px, 3},
                                     {{1, kPalmAnchors, kPalmValues}, {1, kPalmAnchors, 1}}};
  auto network = open_mediapipe_network(file, kShapes);
  if (!network) return tl::make_unexpected(network.error());
  return MediapipePalmNetwork(std::move(*network));
}

Result<std::vector<Region>> MediapipePalmNetwork::search(renderer::GreyView image) {
  const Region whole = region_of_image(image.width, image.height);
  crop_.cut(image, whole);
  crop_.write_rgb(network_->input(0));
  if (const auto done = network_->run(); !done) return tl::make_unexpected(done.error());
  std::vector<Region> regions;
  for (const auto& palm : decode_palms(network_->output(0), network_->output(1)))
    regions.push_back(region_of_palm(palm, whole));
  return regions;
}

}  // namespace handcast::landmarks
