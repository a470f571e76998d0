// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "renderer/correct/outline_parts.hpp"

namespace handcast::renderer {

/// Moves the two borders of a drawn palm onto the outline of the mask. No landmark says how broad a
/// person's palm is at the heel of the hand, or how far the ball of the thumb reaches. At six
/// stations from the wrist to the knuckles, the ends of the mask are compared with the drawn ones.
/// What both borders share is where the palm is now, and is averaged over a tenth of a second; what
/// remains of each is the person's shape, and is averaged over seconds in which the hand is open
/// and faces the camera or turns its back to it. A hand that is seen from its edge is not moved.
/// Between the stations at the wrist and at the knuckles, the thumb is in the way of its border.
/// See `docs/method.md#correct`. One thread.
class PalmOutline {
 public:
  /// For the palm of `mesh`. Nothing is displaced yet.
  explicit PalmOutline(const HandMesh& mesh);

  /// Measures one frame that was drawn with move(): its vertices and landmarks after all
  /// corrections, and the mask of the hand at the same time, all in projector px. `vertices_px`:
  /// one per vertex of the mesh.
  void measure(std::int64_t time_ns, std::span<const glm::vec2> vertices_px,
               const LandmarkPoints& landmarks_px, GreyView mask);

  /// Moves the palm's vertices by what was measured, in place. `landmarks_px`: where they are
  /// drawn.
  void move(const LandmarkPoints& landmarks_px, std::span<glm::vec2> vertices_px) const;

 private:
  static constexpr std::size_t kStations = 6, kBorders = 2;

  /// The palm as it is drawn: the axes begin at the wrist and lead to the knuckles, across from the
  /// little finger to the thumb.
  struct Palm {
    Axes axes;
    float length_px = 0;
    float frontal = 0;  ///< 0: seen from the edge; 1: from its front or back
  };
  /// One border at one station. Lengths are in lengths of the palm, positive towards the thumb.
  struct Border {
    float drawn = 0;   ///< from the line from wrist to knuckles, without displacement
    float moved = 0;   ///< the displacement
    float person = 0;  ///< the part of it that is the person's shape
    float seen_s = 0;  ///< for how long that was measured, s
  };
  struct Station {
    std::array<Border, kBorders> borders;  ///< of the little finger, of the thumb
    Lasting shared;                        ///< displacement of the palm
    std::int64_t last_ns = 0;              ///< when it was looked at
  };
  struct Vertex {
    std::uint16_t index;
    float share;  ///< the palm's weight in it
  };

  static std::optional<Palm> palm_of(const LandmarkPoints& landmarks_px);
  std::optional<float> outside(const Palm& palm, std::size_t station, std::size_t border,
                               float drawn, const LandmarkPoints& landmarks_px,
                               GreyView mask) const;
  void measure_station(std::size_t index, const Palm& palm, const Section& section, float step_s,
                       const LandmarkPoints& landmarks_px, GreyView mask);
  float shared_at(std::size_t station) const;

  std::vector<MeshEdge> edges_;
  std::vector<Vertex> vertices_;
  std::array<Station, kStations> stations_;
  std::size_t station_ = 0;  ///< the one that was looked at last
  std::int64_t last_ns_ = 0;
  glm::vec2 last_px_{0};  ///< the middle of the knuckles
};

}  // namespace handcast::renderer
