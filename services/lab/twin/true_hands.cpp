// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/true_hands.hpp"

#include <fmt/format.h>

#include <future>

#include "ipc/base/log.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/ground_truth_mesh.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

float breadth_m(const JointFrames& rest) {
  constexpr int kIndexKnuckle = 7, kLittleKnuckle = 22;
  return glm::distance(glm::vec3(rest[kIndexKnuckle][3]), glm::vec3(rest[kLittleKnuckle][3]));
}

/// The widths of the person relative to those of a model whose palm is as broad in proportion as
/// the mean person's.
float size_of(const renderer::HandShape& person, const HandMesh& model) {
  const auto mean = renderer::HandShape::mean();
  constexpr std::size_t kIndex = 1;
  return person.radius_mm[kIndex][0] / mean.radius_mm[kIndex][0] *
         breadth_m(renderer::rest_frames(mean)) / breadth_m(model.rest);
}

class PersonsHands final : public TrueHands {
 public:
  struct Model {
    HandMesh drawn;
    GroundTruthMesh truth;
    bool made_by_handcast = false;  ///< the drawn mesh: it can be made again for a person
    bool seen = false;
  };

  PersonsHands(std::array<Model, 2> models, const config::TwinShape& settings, int seed,
               const renderer::HandShape& person)
      : models_(std::move(models)),
        settings_(settings),
        flesh_(Flesh::draw(settings, seed)),
        person_(person) {}

  const TrueHand& of(Side side) const override {
    std::call_once(made_,
                   [this] { in_both([this](Side each) { hands_[index(each)] = make(each); }); });
    return hands_[index(side)];
  }

  const HandMesh& drawn(Side side) const override { return models_[index(side)].drawn; }

  const std::vector<SurfacePoint>& texture(Side side) const override {
    std::call_once(mapped_,
                   [this] { in_both([this](Side each) { maps_[index(each)] = map(each); }); });
    return maps_[index(side)];
  }

  std::string mesh_name() const override {
    if (!models_[0].truth.is_drawn_mesh) return settings_.mesh;
    return settings_.mesh == "handcast"
               ? settings_.mesh
               : fmt::format("handcast, because {} is not installed", settings_.mesh);
  }

 private:
  static std::size_t index(Side side) { return static_cast<std::size_t>(side); }

  template <class Work>
  static void in_both(const Work& work) {
    auto left = std::async(std::launch::async, [&] { work(Side::left); });
    work(Side::right);
    left.get();
  }

  TrueHand make(Side side) const {
    const Model& model = models_[index(side)];
    if (!model.seen) return {model.drawn, settings_.skinning, {}, {}};
    const JointFrames rest = rest_pose(side, person_);
    const bool refits = model.truth.is_drawn_mesh && model.made_by_handcast;
    if (refits)
      return flesh_on_bones(renderer::refit_hand(model.drawn, person_), rest, 1, flesh_,
                            settings_.skinning);
    return flesh_on_bones(model.truth.mesh, rest, size_of(person_, model.truth.mesh), flesh_,
                          settings_.skinning);
  }

  /// Made on the drawn mesh's own bones, where the two surfaces are most alike. It holds for every
  /// person, because only the places of the vertices differ.
  std::vector<SurfacePoint> map(Side side) const {
    const auto& [drawn, truth, made_by_handcast, seen] = models_[index(side)];
    if (truth.is_drawn_mesh) return own_texture_map(drawn);
    const float size = breadth_m(drawn.rest) / breadth_m(truth.mesh.rest);
    const TrueHand same = flesh_on_bones(truth.mesh, drawn.rest, size, Flesh::of_model(),
                                         config::TwinSkinning::linear);
    return texture_map(drawn, same.mesh);
  }

  std::array<Model, 2> models_;
  config::TwinShape settings_;
  Flesh flesh_;
  renderer::HandShape person_;
  mutable std::once_flag made_, mapped_;
  mutable std::array<TrueHand, 2> hands_;
  mutable std::array<std::vector<SurfacePoint>, 2> maps_;
};

}  // namespace

Result<std::unique_ptr<TrueHands>> TrueHands::create(const config::Rig& rig,
                                                     std::array<bool, 2> seen,
                                                     const renderer::HandShape& person) {
  std::array<PersonsHands::Model, 2> models;
  for (const Side side : {Side::left, Side::right}) {
    const std::filesystem::path file = side == Side::left ? rig.hand.left : rig.hand.right;
    auto drawn = renderer::load_hand_or_default(file, side);
    if (!drawn) return tl::make_unexpected(drawn.error());
    auto truth = load_ground_truth_mesh(rig.twin.shape.mesh, *drawn);
    if (!truth) return tl::make_unexpected(truth.error());
    const auto s = static_cast<std::size_t>(side);
    models[s] = {std::move(*drawn), std::move(*truth), file.empty(), seen[s]};
  }
  if (models[0].truth.is_drawn_mesh && rig.twin.shape.mesh != "handcast")
    log::warning(
        "twin.shape.mesh: the hand '{}' is not installed; the true hand has the mesh that is "
        "drawn, "
        "which flatters the method (`scripts/setup --hands` installs it)",
        rig.twin.shape.mesh);
  return std::make_unique<PersonsHands>(std::move(models), rig.twin.shape, rig.twin.seed, person);
}

}  // namespace handcast::twin
