// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/handcast_model.hpp"

#include <fmt/format.h>

#include <numbers>

#include "ipc/base/clock.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/landmarks/models/mediapipe_files.hpp"

namespace handcast::landmarks {
namespace {

namespace fs = std::filesystem;
using namespace handcast_network;

bool is_handcast_network(const Network& network) {
  const std::array<std::vector<int>, 2> inputs{
      {{1, 1, kSide_px, kSide_px}, {1, msg::kLandmarks, kMapCells, kMapCells}}};
  const std::vector<int> output{1, 2 * msg::kLandmarks + 1, kHeatCells, kHeatCells};
  const auto ins = network.inputs(), outs = network.outputs();
  return ins.size() == 2 && outs.size() == 1 && ins[0].shape == inputs[0] &&
         ins[1].shape == inputs[1] && outs[0].shape == output;
}

}  // namespace

Result<HandcastModel> HandcastModel::open(const fs::path& file) {
  auto network = open_network(file);
  if (!network) return tl::make_unexpected(network.error());
  if (!is_handcast_network(**network))
    return fail(Errc::bad_config,
                fmt::format("'{}' is not handcast's landmark network", file.string()));
  return HandcastModel(std::move(*network));
}

Result<LandmarkEstimate> HandcastModel::estimate(renderer::GreyView image, const Region& region,
                                                 msg::Side side,
                                                 const std::optional<Points>& tracker_px,
                                                 EstimateTimes& times) {
  const std::int64_t begin_ns = now_ns();
  crop_.cut(image, region);
  write_image(crop_.pixels(), side, network_->input(0));
  write_tracker(tracker_px ? std::optional(to_places(region, side, *tracker_px)) : std::nullopt,
                network_->input(1));
  const std::int64_t cut_ns = now_ns();
  const auto done = network_->run();
  times.crop_ns += cut_ns - begin_ns;
  times.network_ns += now_ns() - cut_ns;
  if (!done) return tl::make_unexpected(done.error());
  const Answer answer = read_answer(network_->output(0));
  LandmarkEstimate estimate{.points_px = to_image(region, side, answer.places),
                            .presence = answer.presence};
  for (std::size_t i = 0; i < estimate.sigma_px.size(); ++i)
    estimate.sigma_px[i] = std::numbers::sqrt2_v<float> * answer.sigma[i] * region.size_px;
  return estimate;
}

fs::path shipped_network_file() {
  return renderer::default_hand_file(msg::Side::left).parent_path() / "landmarks" / "handcast.onnx";
}

std::vector<fs::path> handcast_files(const ModelOptions& options) {
  return {options.handcast_network.empty() ? shipped_network_file() : options.handcast_network};
}

Result<OpenedModel> open_handcast_model(const ModelOptions& options) {
  std::error_code ignored;
  const bool is_shipped = options.handcast_network.empty();
  const fs::path file = handcast_files(options).front();
  if (is_shipped && !fs::exists(file, ignored))
    return fail(
        Errc::bad_config,
        fmt::format(
            "'{}', which comes with handcast, is missing; set HANDCAST_ASSETS to the folder of the "
            "assets",
            file.string()));
  auto landmarks = HandcastModel::open(file);
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  OpenedModel opened{std::make_unique<HandcastModel>(std::move(*landmarks)), std::nullopt};
  const fs::path palm_file = options.folder / kMediapipePalmFile;
  if (!fs::exists(palm_file, ignored)) return opened;
  auto palms = MediapipePalmNetwork::open(palm_file);
  if (!palms) return tl::make_unexpected(palms.error());
  opened.palms = std::move(*palms);
  return opened;
}

}  // namespace handcast::landmarks
