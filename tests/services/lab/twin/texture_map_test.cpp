// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/texture_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "services/lab/twin/ground_truth_mesh.hpp"
#include "services/lab/twin/surface.hpp"
#include "services/lab/twin/texture_lookup.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

/// The drawn hand, another flesh on the same bones, and the map between them.
struct Mapped {
  HandMesh drawn, flesh;
  std::vector<SurfacePoint> map;
  std::vector<glm::vec3> at;  ///< by vertex of the drawn mesh: its place on the flesh
};

Mapped mapped(HandMesh drawn, HandMesh flesh) {
  Mapped both{std::move(drawn), std::move(flesh), {}, {}};
  both.map = texture_map(both.drawn, both.flesh);
  for (const auto& point : both.map) both.at.push_back(point.on(both.flesh, both.flesh.positions));
  return both;
}

HandMesh mapped_hand() { return *renderer::load_hand_or_default({}, Side::left); }

/// The drawn hand with other widths: the flesh that the map must recover is known.
Mapped mapped_to_hand_of_width(float width) {
  const HandMesh drawn = mapped_hand();
  Flesh thick = Flesh::of_model();
  thick.width.fill(width);
  return mapped(drawn,
                flesh_on_bones(drawn, drawn.rest, 1, thick, config::TwinSkinning::linear).mesh);
}

double percentile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

TEST(TextureMap, OfAMeshOntoItselfIsTheIdentity) {
  const HandMesh drawn = mapped_hand();
  const auto both = mapped(drawn, drawn);
  for (std::size_t v = 0; v < drawn.vertex_count(); ++v)
    ASSERT_LT(glm::distance(both.at[v], drawn.positions[v]), 1e-5f) << v;
  const auto own = own_texture_map(drawn);
  for (std::size_t v = 0; v < drawn.vertex_count(); ++v)
    ASSERT_EQ(own[v].on(drawn, drawn.positions), drawn.positions[v]) << v;
}

TEST(TextureMap, FindsTheSamePlacesOnThinnerAndThickerHands) {
  for (const float width : {0.85f, 1.15f}) {
    const auto both = mapped_to_hand_of_width(width);
    const auto behind = behind_wrist_m(both.drawn);
    std::vector<double> off_mm;
    for (std::size_t v = 0; v < both.drawn.vertex_count(); ++v)
      if (behind[v] < 0) off_mm.push_back(1e3 * glm::distance(both.at[v], both.flesh.positions[v]));
    fmt::print("{} times as wide: off by mean {:.2f}, p95 {:.2f} mm\n", width,
               std::accumulate(off_mm.begin(), off_mm.end(), 0.0) / double(off_mm.size()),
               percentile(off_mm, 0.95));
    EXPECT_LT(percentile(off_mm, 0.5), 0.5);
    EXPECT_LT(percentile(off_mm, 0.95), 1.5);
  }
}

/// True if of any two neighbours on a finger, the one nearer to the tip stays nearer.
bool rows_keep_their_order(const Mapped& both, const std::vector<int>& fingers) {
  constexpr std::array<int, 5> kFirst{3, 7, 12, 17, 22}, kTip{5, 10, 15, 20, 25};
  for (const auto& triangle : both.drawn.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = triangle[k], b = triangle[(k + 1) % 3];
      if (fingers[a] < 0 || fingers[a] != fingers[b]) continue;
      const auto f = static_cast<std::size_t>(fingers[a]);
      const glm::vec3 along = glm::normalize(glm::vec3(both.drawn.rest[kTip[f]][3]) -
                                             glm::vec3(both.drawn.rest[kFirst[f]][3]));
      const float step_m = glm::dot(both.drawn.positions[b] - both.drawn.positions[a], along);
      if (step_m > 1e-3f && glm::dot(both.at[b] - both.at[a], along) <= 0) return false;
    }
  return true;
}

/// What is asked of a map to another hand: the rows along each finger keep their order, the surface
/// is not turned over, and no point is far away.
void expect_a_sound_map(const Mapped& both) {
  const auto fingers = fingers_of(both.drawn);
  const auto behind = behind_wrist_m(both.drawn);
  std::map<int, std::vector<double>> far_mm;
  for (std::size_t v = 0; v < both.drawn.vertex_count(); ++v)
    if (behind[v] < -0.01f)
      far_mm[fingers[v]].push_back(1e3 * glm::distance(both.at[v], both.drawn.positions[v]));
  for (const auto& [finger, values] : far_mm) {
    fmt::print("finger {:2}: distance p50 {:.1f}, p95 {:.1f}, most {:.1f} mm\n", finger,
               percentile(values, 0.5), percentile(values, 0.95), percentile(values, 1));
    EXPECT_LT(percentile(values, 0.95), 9) << finger;
  }
  int turned_over = 0, of = 0;
  for (const auto& [a, b, c] : both.drawn.triangles) {
    if (behind[a] > -0.01f) continue;
    const auto normal = [&](const std::vector<glm::vec3>& at) {
      return glm::cross(at[b] - at[a], at[c] - at[a]);
    };
    ++of;
    turned_over += glm::dot(normal(both.at), normal(both.drawn.positions)) < 0;
  }
  fmt::print("{} of {} triangles turned over\n", turned_over, of);
  EXPECT_TRUE(rows_keep_their_order(both, fingers));
  EXPECT_LT(turned_over, of / 100);
}

void expect_a_sound_map_to(const std::string& mesh) {
  const HandMesh drawn = mapped_hand();
  const auto model = load_ground_truth_mesh(mesh, drawn);
  ASSERT_TRUE(model) << model.error().what;
  ASSERT_FALSE(model->is_drawn_mesh);
  expect_a_sound_map(mapped(drawn, flesh_on_bones(model->mesh, drawn.rest, 1, Flesh::of_model(),
                                                  config::TwinSkinning::linear)
                                       .mesh));
}

TEST(TextureMap, ToTheWebxrHandKeepsTheOrderAlongFingersAndTurnsNothingOver) {
  if (webxr_hand_file().empty())
    GTEST_SKIP() << "the WebXR hand is not installed; see scripts/setup --hands";
  expect_a_sound_map_to("webxr");
}

TEST(TextureMap, ToTheImplicitHandKeepsTheOrderAlongFingersAndTurnsNothingOver) {
  expect_a_sound_map_to("implicit");
}

TEST(TextureLookup, FindsEachVertexByItsTextureCoordinates) {
  const HandMesh drawn = mapped_hand();
  const TextureLookup lookup(drawn);
  for (std::size_t v = 0; v < drawn.vertex_count(); ++v)
    ASSERT_LT(glm::distance(lookup.at(drawn.uv[v]).on(drawn, drawn.positions), drawn.positions[v]),
              2e-4f)
        << v;
}

TEST(TextureLookup, TakesTheNearestPointForCoordinatesBesideTheCharts) {
  const HandMesh drawn = mapped_hand();
  const TextureLookup lookup(drawn);
  for (const glm::vec2 uv : {glm::vec2(-0.1f, 0.5f), glm::vec2(2, 2), glm::vec2(0.5f, 0)}) {
    float nearest = 10;
    for (const auto& vertex : drawn.uv) nearest = std::min(nearest, glm::distance(vertex, uv));
    const auto found = lookup.at(uv);
    glm::vec2 at(0);
    for (int k = 0; k < 3; ++k) at += found.share[k] * drawn.uv[drawn.triangles[found.triangle][k]];
    EXPECT_LE(glm::distance(at, uv), nearest + 1e-5f);
  }
}

}  // namespace
}  // namespace handcast::twin
