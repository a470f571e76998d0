// SPDX-License-Identifier: Apache-2.0
// A .glb file as the model of a hand: read, painted, skinned, corrected, repaired, and scored as
// the true hand of the twin.
// Limits: 10 s and 1 GB per input.
#include <algorithm>
#include <cmath>

#include "ipc/msg/owned.hpp"
#include "renderer/content/chart_map.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/correct/foldover_repair.hpp"
#include "renderer/skin/hand_surface.hpp"
#include "services/lab/twin/twin.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
using renderer::HandMesh;

constexpr std::int64_t kTime_ns = 500'000'000;

msg::HandPose pose_in(const twin::Twin& twin) {
  for (std::uint64_t k = 0; k < 100; ++k)
    if (const auto sample = twin.tracker_sample(k); sample.poses.count > 0)
      return sample.poses.hands[0];
  std::abort();
}

/// Skins the mesh, moves it by 20 px and turns a finger; returns the projection of the result.
msg::Owned<msg::Projection> draw(const HandMesh& mesh, const twin::Twin& twin,
                                 const calib::Calibration& calibration) {
  const config::Cascade cascade;
  renderer::HandSurface surface(mesh, cascade.mask.forearm_mm);
  auto skinned = surface.pose(pose_in(twin), cascade.skin, calibration, 0.5f);
  renderer::LandmarkPoints p{}, q{};
  const auto seen = *twin.landmarks(msg::Side::left, kTime_ns);
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = calibration.projector.pixel_of(seen[i]);
    q[i] = p[i] + glm::vec2(i % 4 == 0 ? -20 : 20, static_cast<float>(i));
  }
  renderer::correct_vertices(cascade.correct, surface.mesh(), p, q, skinned.projected_px);
  renderer::FoldoverRepair repair(surface.mesh());
  fuzz::require(repair.repair(skinned.seen_px, skinned.projected_px, skinned.facing_sign) >= 0);

  msg::Owned<msg::Projection> projection;
  projection->lit_ns = kTime_ns;
  projection->hand_count = 1;
  auto& hand = projection->hands[0];
  hand.side = msg::Side::left;
  hand.vertex_count =
      static_cast<std::uint32_t>(std::min<std::size_t>(mesh.vertex_count(), msg::kMaxVertices));
  for (std::uint32_t v = 0; v < hand.vertex_count; ++v)
    hand.landings[v] = {skinned.projected_px[v].x, skinned.projected_px[v].y};
  return projection;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::MemoryFile file;
  file.write({data, size});
  const auto mesh = renderer::load_hand(file.path(), msg::Side::left);
  if (!mesh) return 0;
  const renderer::ChartMap charts(*mesh, 256, 160);

  config::Rig rig;
  rig.hand.left = rig.hand.right = file.path();
  const auto calibration = calib::reference_rig();
  const auto twin = twin::Twin::create(rig, calibration);
  fuzz::require(twin.has_value());
  const auto projection = draw(*mesh, **twin, calibration);
  const auto judge = twin::Judge::create(**twin, 8);
  for (const auto& hand : judge->score(*projection).hands)
    fuzz::require(hand.hand_px >= 0 && hand.lit_px <= hand.hand_px);
  return 0;
}
