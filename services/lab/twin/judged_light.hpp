// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"

namespace handcast::twin {

/// The light of one projection, which must outlive it, as the judge reads it.
class JudgedLight {
 public:
  /// Reads it.
  explicit JudgedLight(const msg::Projection& projection);

  /// The pixels that may be lit.
  const renderer::Rect& region() const { return region_; }
  /// The light of a pixel by colour (red, green, blue), 0..1; and the brightest of them.
  /// @{
  glm::vec3 colour_at(int x, int y) const;
  float light_at(int x, int y) const {
    const glm::vec3 light = colour_at(x, y);
    return std::max({light.r, light.g, light.b});
  }
  /// @}
  /// Writes the alpha of [x0 .. x1) of row y of the projector.
  void row(int y, int x0, int x1, std::uint8_t* alpha) const;
  /// The least alpha with which a pixel of a hand has half of the intended light; 256: none has.
  int least_alpha(msg::Side side) const { return least_alpha_[static_cast<std::size_t>(side)]; }

  /// The hand and the texture coordinates that a pixel shows.
  struct Shown {
    msg::Side side;
    glm::vec2 uv;
  };
  /// What a pixel shows whose coordinates are multiples of kShownStep_px; empty if it is dark.
  std::optional<Shown> shown(int x, int y) const;

 private:
  std::uint32_t hand_count() const;

  const msg::Projection& projection_;
  renderer::Rect region_;
  std::array<int, 2> least_alpha_{128, 128};
};

}  // namespace handcast::twin
