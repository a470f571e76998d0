// SPDX-License-Identifier: Apache-2.0
#include "renderer/register/contour.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

constexpr int kSpacing_px = 6;  ///< between the rows, and between the columns, whose ends are taken
constexpr int kMargin_px = 3;   ///< closer to the image's border nothing is taken
constexpr float kSolid_px =
    2;  ///< so far on either side of an edge there is hand, and none: specks have no edge
constexpr float kLeastSlope = 8;  ///< of the grey values over the slope's window; less is no edge

/// Away from the bright side; zero where there is none. Differences over four pixels in five rows
/// and columns.
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
  /// The edge between two neighbouring pixels, if the grey value makes it and it runs rather across
  /// than along their line.
  void take(glm::ivec2 here, glm::ivec2 before, bool here_lit) {
    const glm::ivec2 in = here_lit ? here : before, out = here_lit ? before : here;
    const auto edge = static_cast<float>(silhouette_.threshold) + 0.5f;
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

  /// Keeps every second point, of what follows too.
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
  int seen_ = 0, stride_ = 1;  ///< points of the edge, of which every `stride_`th is taken
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
  // The mask's pixels say where to within about one: the grey values say where in it.
  const auto edge = static_cast<float>(silhouette.threshold) + 0.5f;
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
