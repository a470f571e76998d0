// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_model.hpp"

#include "ipc/base/clock.hpp"
#include "services/landmarks/models/mediapipe_files.hpp"
#include "services/landmarks/models/mediapipe_palms.hpp"

namespace handcast::landmarks {

Result<MediapipeModel> MediapipeModel::open(const std::filesystem::path& file) {
  static const NetworkShapes kShapes{
      "the hand landmark network", {1, kSide_px, kSide_px, 3}, {{1, 63}, {1, 1}, {1, 1}, {1, 63}}};
  auto network = open_mediapipe_network(file, kShapes);
  if (!network) return tl::make_unexpected(network.error());
  return MediapipeModel(std::move(*network));
}

Region MediapipeModel::region_around(const Points& points_px) const {
  return mediapipe_region_of_landmarks(points_px);
}

Result<LandmarkEstimate> MediapipeModel::estimate(renderer::GreyView image, const Region& region,
                                                  msg::Side, const std::optional<Points>&,
                                                  EstimateTimes& times) {
  const std::int64_t begin_ns = now_ns();
  crop_.cut(image, region);
  crop_.write_rgb(network_->input(0));
  const std::int64_t cut_ns = now_ns();
  const auto done = network_->run();
  times.crop_ns += cut_ns - begin_ns;
  times.network_ns += now_ns() - cut_ns;
  if (!done) return tl::make_unexpected(done.error());

  LandmarkEstimate estimate;
  // x, y, z of each point in pixels of the crop, where 0 is the centre of the first pixel: measured
  // on mirrored images.
  const auto values = network_->output(0);
  for (std::size_t i = 0; i < estimate.points_px.size(); ++i)
    estimate.points_px[i] = region.to_image(
        (glm::vec2(values[3 * i], values[3 * i + 1]) + 0.5f) / static_cast<float>(kSide_px) - 0.5f);
  estimate.presence = network_->output(1)[0];
  // The output scores a right hand. MediaPipe takes images for mirrored and calls it "Left".
  estimate.left_score = 1 - network_->output(2)[0];
  return estimate;
}

std::vector<std::filesystem::path> mediapipe_files(const ModelOptions& options) {
  return {options.folder / kMediapipeHandFile, options.folder / kMediapipePalmFile};
}

Result<OpenedModel> open_mediapipe_model(const ModelOptions& options) {
  auto landmarks = MediapipeModel::open(options.folder / kMediapipeHandFile);
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  auto palms = MediapipePalmNetwork::open(options.folder / kMediapipePalmFile);
  if (!palms) return tl::make_unexpected(palms.error());
  return OpenedModel{std::make_unique<MediapipeModel>(std::move(*landmarks)), std::move(*palms)};
}

}  // namespace handcast::landmarks
