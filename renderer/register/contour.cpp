// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "renderer/register/registration.hpp"

namespace handcast::renderer {
namespace {

constexpr int kSpacing_px = 6;  ///< between the rows, and between the columns, that are searched
constexpr int kMargin_px = 3;   ///< no points are taken closer to the border of the image
/// An edge has hand up to this distance on one side and none on the other. Specks have no edge.
constexpr float kSolid_px = 2;
constexpr float kLeastSlope = 8;  ///< least sum of the differences in outward()

/// Unit vector away from the bright side, from differences over four pixels in five rows and
/// columns. Zero if they are too small.
glm::vec2 outward(GreyView image, int x, int y) {
  int across = 0, down = 0;
  for (int i = -2; i <= 2; ++i) {
    across += image.at(x + 2, y + i) - image.at(x - 2, y + i);
    down += image.at(x + i, y + 2) - image.at(x + i, y - 2);
  }
  const glm::vec2 slope(across, down);
  const float steepness = glm::length(slope);
  return steepness < kLeastSlope ? glm::vec2(0) : -slope / steepness;
}

class ContourBuilder {
 public:
  ContourBuilder(const Silhouette& silhouette, Contour& contour)
      : silhouette_(silhouette),
        contour_(contour),
        inner_(
            silhouette.region.overlap({kMargin_px, kMargin_px, silhouette.image.width - kMargin_px,
                                       silhouette.image.height - kMargin_px})) {
    contour_.count = 0;
  }

  void take_row_ends() {
    const int first = (inner_.y0 + kSpacing_px - 1) / kSpacing_px * kSpacing_px;
    for (int y = first; y < inner_.y1; y += kSpacing_px) {
      const std::uint8_t* mask = silhouette_.mask.row(y);
      for (int x = inner_.x0; x <= inner_.x1; ++x)
        if (mask[x] != mask[x - 1]) take({x, y}, {x - 1, y}, mask[x] != 0);
    }
  }

  void take_column_ends() {
    const int first = (inner_.x0 + kSpacing_px - 1) / kSpacing_px * kSpacing_px;
    for (int y = inner_.y0; y <= inner_.y1; ++y) {
      const std::uint8_t *mask = silhouette_.mask.row(y), *above = silhouette_.mask.row(y - 1);
      for (int x = first; x < inner_.x1; x += kSpacing_px)
        if (mask[x] != above[x]) take({x, y}, {x, y - 1}, mask[x] != 0);
    }
  }

 private:
  /// Adds the edge between two neighbouring pixels, if the grey values cross the threshold there
  /// and the normal is within 45 degrees of the line through the pixels.
  void take(glm::ivec2 here, glm::ivec2 before, bool here_lit) {
    const glm::ivec2 in = here_lit ? here : before, out = here_lit ? before : here;
    const float edge = silhouette_.edge_at(in);
    const float bright = silhouette_.image.at(in.x, in.y),
                dark = silhouette_.image.at(out.x, out.y);
    if (!(dark < edge && bright > edge)) return;
    const glm::vec2 normal = outward(silhouette_.image, in.x, in.y), step = out - in;
    if (glm::dot(normal, step) < 0.70f || seen_++ % stride_ != 0) return;
    if (contour_.count == Contour::kMostPoints) thin_out();
    const float share = (bright - edge) / (bright - dark);
    contour_.points_px[contour_.count] = glm::vec2(in) + share * step;
    contour_.normals[contour_.count++] = normal;
  }

  /// Keeps every second point, and halves the rate of the points to come.
  void thin_out() {
    contour_.count /= 2;
    for (int i = 0; i < contour_.count; ++i) {
      contour_.points_px[i] = contour_.points_px[2 * i];
      contour_.normals[i] = contour_.normals[2 * i];
    }
    stride_ *= 2;
  }

  const Silhouette& silhouette_;
  Contour& contour_;
  Rect inner_;
  int seen_ = 0, stride_ = 1;  ///< points found so far, of which every `stride_`th is taken
};

}  // namespace

void find_contour(const Silhouette& silhouette, Contour& contour) {
  ContourBuilder builder(silhouette, contour);
  builder.take_row_ends();
  builder.take_column_ends();
}

std::optional<float> edge_along(const Silhouette& silhouette, glm::vec2 from, glm::vec2 direction,
                                float reach_px) {
  const bool inside = silhouette.lit(from);
  const float step = inside ? 1 : -1;
  float at = step;
  while (silhouette.lit(from + at * direction) == inside) {
    at += step;
    if (std::abs(at) > reach_px) return std::nullopt;
  }
  const float last = std::min(at, at - step);
  if (!silhouette.lit(from + (last - kSolid_px) * direction) ||
      silhouette.lit(from + (last + 1 + kSolid_px) * direction))
    return std::nullopt;
  // The mask gives the edge to about a pixel; the grey values give it to a fraction.
  const float edge = silhouette.edge_at(glm::ivec2(from + last * direction + 0.5f));
  float inner = last - 1;
  float bright = silhouette.grey(from + inner * direction);
  for (int i = 0; i < 3; ++i, ++inner) {
    const float dark = silhouette.grey(from + (inner + 1) * direction);
    if (bright > edge && dark < edge) return inner + (bright - edge) / (bright - dark);
    bright = dark;
  }
  return std::nullopt;
}

}  // namespace handcast::renderer
