// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/twin/judged_light.hpp"
#include "services/lab/twin/samples.hpp"
#include "services/lab/twin/texture_lookup.hpp"
#include "services/lab/twin/true_view.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::twin {

/// Scores the light of two projectors together, at the vertices of the true hands that at least one
/// of them can reach, and draws it. One thread.
class SharedJudge {
 public:
  /// `twin`, whose rig has two projectors, must outlive it. `is_white`: white is painted on the
  /// hands, so that a pixel shows how much light was meant for it.
  SharedJudge(const Twin& twin, bool is_white);

  /// Adds a moment: the light of both projectors, each on the hands of its own time (lit_ns, since
  /// the twin's epoch).
  void add(const msg::Projection& first, const msg::Projection& second);

  /// The metrics so far:
  ///
  ///     {"coverage": the share of these vertices with half of the full light or more,
  ///      "coverage_first": the same of the first projector alone,
  ///      "light": {p5, p50, p95} of those with light; 1 is that of one projector's white,
  ///      "step": {p50, p99}: how much the light differs between neighbours with light,
  ///      "apart_mm": {mean, p95}: where both light a vertex, how far apart they put the picture}
  ///
  /// A value that was not measured is null: all but "apart_mm" on hands that are not white.
  nlohmann::json to_json() const;

  /// The hands of the last moment as the camera sees them, RGBA8: with the light of the first
  /// projector, of the second one, and of both. Dark before the first moment. Valid until the next
  /// call.
  renderer::View<const std::uint32_t> picture();

 private:
  /// One projector's light in the last moment.
  struct Beam {
    Beam(const Twin& twin, const calib::Calibration& seen) : view(twin, seen), texture(twin) {}

    TrueView view;
    PlacedTexture texture;
    const msg::Projection* projection = nullptr;
  };
  static void take(Beam& beam, const msg::Projection& projection);
  static std::optional<glm::vec3> displacement(const Beam& beam, const JudgedLight& light,
                                               std::size_t hand, std::size_t vertex);
  static glm::vec3 light_on(const Beam& beam, Surface surface, const glm::vec3& share);
  void add_hand(std::size_t hand, const std::array<JudgedLight, 2>& lights);
  void add_light(std::size_t vertex, const std::array<float, 2>& light);

  bool is_white_;
  std::array<Beam, 2> beams_;
  TrueView eye_;
  Samples light_, steps_, apart_mm_;
  std::vector<float> of_vertex_;  ///< light by vertex; negative: it is not reached
  std::int64_t reached_ = 0, covered_ = 0, covered_first_ = 0;
  renderer::Image<std::uint32_t> picture_;
};

}  // namespace handcast::twin
