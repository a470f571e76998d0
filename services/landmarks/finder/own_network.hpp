// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "ipc/msg/hand_poses.hpp"
#include "services/landmarks/finder/crop.hpp"
#include "services/landmarks/finder/landmark_model.hpp"
#include "services/landmarks/finder/region.hpp"
#include "services/landmarks/inference/network.hpp"

/// Our own landmark network (training/MODEL_CARD.md): what it is shown and what its answer means.
/// Training shows it the same.
namespace handcast::landmarks::own {

inline constexpr int kSide_px = 96;    ///< of the crop
inline constexpr int kMapCells = 24;   ///< across a map of the tracker's joints
inline constexpr int kHeatCells = 12;  ///< across a heat map

/// The square to look in: around all landmarks (or the tracker's joints), upright, with room for
/// their errors.
Region region_around(const Points& points_px);

/// Places in the crop, 0..1 from its left and upper edge; those of a left hand are mirrored, for
/// the network only knows right ones.
using Places = std::array<glm::vec2, msg::kLandmarks>;
Places to_places(const Region& region, msg::Side side, const Points& points_px);
Points to_image(const Region& region, msg::Side side, const Places& places);

/// What the network is shown for each grey value: 0 to kMostShown as a multiple of the crop's 98th
/// percentile, less kShownShift.
inline constexpr float kMostShown = 1.5f, kShownShift = 0.4f;
std::array<float, 256> shown_values(std::span<const std::uint8_t> pixels);

/// Fills the network's first input, kSide_px x kSide_px.
void write_image(std::span<const std::uint8_t> pixels, msg::Side side, std::span<float> input);
/// Fills its second input, kLandmarks x kMapCells x kMapCells: a Gaussian at each joint of the
/// tracker; zeros where there is none.
void write_tracker(const std::optional<Places>& tracker, std::span<float> input);

/// The network's answer. `sigma` is the scale of a Laplace distribution per axis, in crop sides.
struct Answer {
  Places places{};
  std::array<float, msg::kLandmarks> sigma{};
  float presence = 0;  ///< 0..1: that there is a hand
};
/// `output`: (2 x kLandmarks + 1) x kHeatCells x kHeatCells.
Answer read_answer(std::span<const float> output);

/// The network with its crop. Keeps its buffers; one thread.
class OwnNetwork final : public LandmarkModel {
 public:
  /// Errors (bad_config): as of open_network, and a file that holds another network.
  static Result<OwnNetwork> open(const std::string& backend, const std::filesystem::path& file);

  Region region_around(const Points& points_px) const override {
    return own::region_around(points_px);
  }
  int first_looks() const override { return 2; }
  bool tells_sides() const override { return false; }
  /// Points where the tracker's joints should be.
  Result<Seen> look(renderer::GreyView image, const Region& region, msg::Side side,
                    const std::optional<Points>& tracker_px, Times& times) override;

 private:
  explicit OwnNetwork(std::unique_ptr<Network> network) : network_(std::move(network)) {}

  std::unique_ptr<Network> network_;
  Crop crop_{kSide_px};
};

/// The network that comes with handcast: HANDCAST_ASSETS, or beside the program or the installed
/// share folder.
std::filesystem::path default_network_file();

}  // namespace handcast::landmarks::own
