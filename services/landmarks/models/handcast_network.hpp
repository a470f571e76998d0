// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>

#include "ipc/msg/hand_poses.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"

namespace handcast::landmarks {

/// e^x for x <= 88, with a relative error below 3e-7; an x below -87, or not a number, counts as
/// -87. Written so that the compiler vectorises loops over it. Computes 2^n e^r with |r| <= ln 2 /
/// 2: ln 2 is split into two constants, which keeps r exact, and the Taylor series ends at the
/// precision of a float.
inline float exponential(float x) {
  constexpr float kToWhole = 12582912.0f;  // 1.5 * 2^23: adding it rounds to whole numbers
  const float least = std::max(-87.0f, x);
  const float n = (least * 1.44269504f + kToWhole) - kToWhole;
  const float r = (least - n * 0.693359375f) + n * 2.12194440e-4f;
  const float series =
      1 + r * (1 + r * (0.5f + r * (1.0f / 6 + r * (1.0f / 24 + r * (1.0f / 120 + r / 720)))));
  return series * std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) << 23);
}

}  // namespace handcast::landmarks

/// The inputs and the output of handcast's own landmark network
/// (services/lab/training/MODEL_CARD.md). The training uses the same functions. Functions without
/// state; any thread.
namespace handcast::landmarks::handcast_network {

inline constexpr int kSide_px = 96;    ///< side of the crop
inline constexpr int kMapCells = 24;   ///< cells along a side of a tracker map
inline constexpr int kHeatCells = 12;  ///< cells along a side of a heat map

/// The upright square around all 21 points (landmarks of a moment ago, or the tracker's joints),
/// with a margin for their errors.
Region region_around(const Points& points_px);

/// The 21 points in the crop, 0..1 from its upper left corner. The network knows right hands only,
/// so left hands are mirrored.
using Places = std::array<glm::vec2, msg::kLandmarks>;
/// From the image to the crop.
Places to_places(const Region& region, msg::Side side, const Points& points_px);
/// From the crop to the image.
Points to_image(const Region& region, msg::Side side, const Places& places);

/// The input value of each grey value: its ratio to the 98th percentile of the crop's `pixels`, at
/// most kMostShown, less kShownShift.
std::array<float, 256> shown_values(std::span<const std::uint8_t> pixels);
inline constexpr float kMostShown = 1.5f;   ///< upper limit of the ratio
inline constexpr float kShownShift = 0.4f;  ///< subtracted from the ratio

/// Fills the first input, kSide_px x kSide_px, from the pixels of a crop.
void write_image(std::span<const std::uint8_t> pixels, msg::Side side, std::span<float> input);
/// Fills the second input, kLandmarks x kMapCells x kMapCells: one map per joint of the tracker
/// with a Gaussian at its place, or zeros if there is no tracker.
void write_tracker(const std::optional<Places>& tracker, std::span<float> input);

/// The decoded output.
struct Answer {
  Places places{};                             ///< the landmarks
  std::array<float, msg::kLandmarks> sigma{};  ///< scale of a Laplace distribution per axis, as a
                                               ///< fraction of the crop's side
  float presence = 0;                          ///< 0..1: how likely there is a hand
};
/// Decodes the output, (2 x kLandmarks + 1) x kHeatCells x kHeatCells.
Answer read_answer(std::span<const float> output);

}  // namespace handcast::landmarks::handcast_network
