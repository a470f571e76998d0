// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "services/lab/twin/texture_lookup.hpp"
#include "services/lab/twin/true_view.hpp"

namespace handcast::twin {

/// Where the texture of the drawn hands belongs on the true ones at one time. One thread.
class PlacedTexture {
 public:
  /// `twin` must outlive it.
  explicit PlacedTexture(const Twin& twin);

  /// Places the texture of one hand on its flesh, as it is seen and at rest.
  void place(const SeenHand& hand);

  /// A point of the texture, m.
  struct Point {
    glm::vec3 seen_m;  ///< camera space, at the time of place()
    glm::vec3 rest_m;  ///< model space
  };
  /// The point of these texture coordinates on a hand that was placed.
  Point at(Side side, glm::vec2 uv) const;

 private:
  struct Placed {
    std::vector<glm::vec3> seen_m, rest_m;  ///< by vertex of the drawn mesh
  };
  const Twin& twin_;
  std::array<TextureLookup, 2> lookup_;
  std::array<Placed, 2> placed_;
};

}  // namespace handcast::twin
