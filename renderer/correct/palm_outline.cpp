// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/palm_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

/// Wrist, palm and metacarpals.
constexpr std::array kPalmSkinJoints{0, 1, 2, 6, 11, 16, 21};
/// Of the stations, in lengths of the palm from the wrist.
constexpr float kFirst = 0.02f, kBetween = 0.17f;
/// Where the thumb's border can be compared.
constexpr std::array kHasThumb{true, true, false, false, false, true};

constexpr float kSharedMemory_s = 0.1f, kSharedFade_s = 0.3f;
constexpr float kShared = 0.8f;  ///< what is believed of it: borders may be wrong on one side alone
/// The ball of the thumb ends between two stations.
constexpr std::size_t kBallEnds = 2;
constexpr float kBallShare = 0.5f;
constexpr float kPersonMemory_s = 5, kPersonPrior_s = 0.2f;
constexpr float kLongestPalmStep_s = 0.1f;
constexpr float kFastestPalm_px_s = 1500;  ///< a palm that moves faster is blurred
constexpr float kFarthestBorder = 0.35f;   ///< of a border from the mask's end, in half widths
/// What is a finger or may hide behind one, and by how much beyond a border, in lengths of the
/// palm.
constexpr float kFingerRadius = 0.16f, kBorderMargin = 0.04f;
constexpr float kIsFrontal = 0.9f;
constexpr float kShortest_px = 10;

float station_at(std::size_t index) { return kFirst + kBetween * static_cast<float>(index); }

bool is_far_from_fingers(glm::vec2 place, const LandmarkPoints& px, float radius_px) {
  for (int f = 0; f < 5; ++f)
    for (int k = f == 0 ? 1 : 0; k < 3; ++k)
      if (from_bone_px(place, px, 1 + 4 * f + k, 2 + 4 * f + k) < radius_px) return false;
  return true;
}

}  // namespace

PalmOutline::PalmOutline(const HandMesh& mesh) {
  std::vector<bool> is_palm(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const float share = weight_of(mesh, v, kPalmSkinJoints);
    is_palm[v] = share > 0.5f;
    if (share > 0.01f) vertices_.push_back({static_cast<std::uint16_t>(v), share});
  }
  edges_ = edges_among(mesh, is_palm);
}

std::optional<PalmOutline::Palm> PalmOutline::palm_of(const LandmarkPoints& px) {
  const glm::vec2 way = 0.25f * (px[5] + px[9] + px[13] + px[17]) - px[0];
  const float length_px = glm::length(way);
  if (!(length_px > kShortest_px)) return std::nullopt;
  const glm::vec2 along = way / length_px;
  glm::vec2 across(-along.y, along.x);
  if (glm::dot(across, px[5] - px[17]) < 0) across = -across;
  return Palm{{px[0], along, across}, length_px, frontal_share(px)};
}

/// How far the mask reaches beyond a border that is drawn at `drawn`, in lengths of the palm.
std::optional<float> PalmOutline::outside(const Palm& palm, std::size_t station, std::size_t border,
                                          float drawn, const LandmarkPoints& landmarks_px,
                                          GreyView mask) const {
  if (border == 1 && !kHasThumb[station]) return std::nullopt;
  const auto& [origin, along, across] = palm.axes;
  const glm::vec2 outwards = border == 0 ? -across : across,
                  place = origin + palm.length_px * (station_at(station) * along + drawn * across);
  if (!is_far_from_fingers(place + kBorderMargin * palm.length_px * outwards, landmarks_px,
                           kFingerRadius * palm.length_px))
    return std::nullopt;
  const auto edge =
      edge_px(mask, place, outwards, kFarthestBorder * std::abs(drawn) * palm.length_px);
  return edge ? std::optional(*edge / palm.length_px) : std::nullopt;
}

/// What both borders share, taken from the nearest stations where both are seen.
float PalmOutline::shared_at(std::size_t station) const {
  const auto at = [&](std::size_t i) {
    return kShared * stations_[i].shared.share * stations_[i].shared.value;
  };
  if (kHasThumb[station]) return at(station);
  constexpr std::size_t kBelow = 1, kAbove = 5;
  return glm::mix(at(kBelow), at(kAbove),
                  static_cast<float>(station - kBelow) / static_cast<float>(kAbove - kBelow));
}

void PalmOutline::measure_station(std::size_t index, const Palm& palm, const Section& section,
                                  float step_s, const LandmarkPoints& landmarks_px, GreyView mask) {
  Station& station = stations_[index];
  const std::array drawn{section.low_px / palm.length_px, section.high_px / palm.length_px};
  std::array<std::optional<float>, kBorders> seen;  // displacements that would end the difference
  for (std::size_t b = 0; b < kBorders; ++b) {
    Border& border = station.borders[b];
    border.drawn = drawn[b] - border.moved;
    if (const auto more = outside(palm, index, b, drawn[b], landmarks_px, mask))
      seen[b] = border.moved + (b == 0 ? -*more : *more);
  }
  const float part = 1 - std::exp(-step_s / kSharedMemory_s);
  if (seen[0] && seen[1]) station.shared.add(0.5f * (*seen[0] + *seen[1]), part);
  for (std::size_t b = 0; b < kBorders; ++b) {
    Border& border = station.borders[b];
    if (!seen[b]) continue;
    border.seen_s = std::min(border.seen_s + step_s, kPersonMemory_s);
    border.person +=
        step_s / (kPersonPrior_s + border.seen_s) * (*seen[b] - shared_at(index) - border.person);
  }
}

void PalmOutline::measure(std::int64_t time_ns, std::span<const glm::vec2> vertices_px,
                          const LandmarkPoints& px, GreyView mask) {
  const float since_s = static_cast<float>(ns_to_seconds(time_ns - last_ns_));
  last_ns_ = time_ns;
  for (Station& station : stations_)
    station.shared.fade(std::exp(-std::max(since_s, 0.0f) / kSharedFade_s));
  const auto palm = palm_of(px);
  if (!palm) return;
  const glm::vec2 knuckles_px = palm->axes.origin + palm->length_px * palm->axes.along;
  const bool is_slow = glm::distance(knuckles_px, last_px_) < kFastestPalm_px_s * since_s;
  last_px_ = knuckles_px;
  station_ = (station_ + 1) % kStations;  // one in each frame: a palm changes slowly
  const float step_s =
      std::clamp(static_cast<float>(
                     ns_to_seconds(time_ns - std::exchange(stations_[station_].last_ns, time_ns))),
                 0.0f, kLongestPalmStep_s);
  if (is_slow && palm->frontal > kIsFrontal && is_open(px)) {
    const Section section =
        section_of(edges_, vertices_px, palm->axes, station_at(station_) * palm->length_px);
    if (section.low_px < 0 && section.high_px > 0)
      measure_station(station_, *palm, section, step_s, px, mask);
  }
  stations_[kBallEnds].borders[1].person = kBallShare * stations_[kBallEnds - 1].borders[1].person;
  for (std::size_t i = 0; i < kStations; ++i)
    for (Border& border : stations_[i].borders) {
      const float most = kFarthestBorder * std::abs(border.drawn);
      border.moved = std::clamp(palm->frontal * (shared_at(i) + border.person), -most, most);
    }
}

void PalmOutline::move(const LandmarkPoints& landmarks_px, std::span<glm::vec2> vertices_px) const {
  const auto palm = palm_of(landmarks_px);
  if (!palm) return;
  for (const Vertex& vertex : vertices_) {
    const glm::vec2 from = (vertices_px[vertex.index] - palm->axes.origin) / palm->length_px;
    const float place = std::clamp((glm::dot(from, palm->axes.along) - kFirst) / kBetween, 0.0f,
                                   static_cast<float>(kStations - 1));
    const auto i = std::min(static_cast<std::size_t>(place), kStations - 2);
    const Station &below = stations_[i], &above = stations_[i + 1];
    const float side = glm::dot(from, palm->axes.across), part = place - static_cast<float>(i);
    const std::size_t b = side < 0 ? 0 : 1;
    const float drawn = glm::mix(below.borders[b].drawn, above.borders[b].drawn, part);
    if (!(drawn * side > 0)) continue;
    const float shared = palm->frontal * glm::mix(shared_at(i), shared_at(i + 1), part),
                moved = glm::mix(below.borders[b].moved, above.borders[b].moved, part);
    const float part_of_side = std::min(side / drawn, 1.0f);
    // A border's own displacement falls to 0 at the middle line, with the power 1.5.
    const float far = part_of_side * std::sqrt(part_of_side);
    vertices_px[vertex.index] +=
        vertex.share * (shared + (moved - shared) * far) * palm->length_px * palm->axes.across;
  }
}

}  // namespace handcast::renderer
