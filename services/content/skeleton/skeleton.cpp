// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "services/content/settable_source.hpp"
#include "services/content/surface_map.hpp"

namespace handcast::content {
namespace {

/// A texel near a bone or a joint.
struct LitTexel {
  std::uint32_t index;
  std::uint8_t joint;  ///< whose speed it shows: the far end of the bone
  float from_bone_mm, from_joint_mm;
};

float from_line_mm(const glm::vec2& place, const glm::vec2& from, const glm::vec2& to) {
  const glm::vec2 along = to - from;
  const float part = glm::dot(place - from, along) / std::max(glm::dot(along, along), 1e-6f);
  return glm::distance(place, from + along * std::clamp(part, 0.f, 1.f));
}

/// The skeleton where it lies under the skin at rest, seen from the back or from the palm. A bone
/// has the colour `colour` at rest, and `fast` at 1 m/s and more, relative to the wrist.
class SkeletonSource final : public SettableSource {
 public:
  explicit SkeletonSource(const Opening& opening)
      : SettableSource(
            {plain_parameter("colour", "Colour", Parameter::Kind::colour, {0.75, 0.9, 1, 1}),
             plain_parameter("fast", "Colour in motion", Parameter::Kind::colour, {1, 0.3, 0.1, 1}),
             number_parameter("width", "Width of a bone, mm", 0.5, 20, 3)}),
        map_(surface_map_of(*opening.meshes[static_cast<std::size_t>(opening.side)], opening.width,
                            opening.height)) {
    find_texels(*opening.meshes[static_cast<std::size_t>(opening.side)]);
  }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    const bool has_new_speeds = measure(*moment.hand, moment.step_s);
    if (!take_change() && !has_new_speeds && moment.frame > 0) return false;
    const auto slow = numbers("colour"), fast = numbers("fast");
    const auto width_mm = static_cast<float>(number("width"));
    std::array<glm::vec4, kJoints> colours;
    for (std::size_t joint = 0; joint < kJoints; ++joint)
      for (int k = 0; k < 4; ++k)
        colours[joint][k] = static_cast<float>(
            std::lerp(slow[static_cast<std::size_t>(k)], fast[static_cast<std::size_t>(k)],
                      static_cast<double>(shown_[joint]) / kLevels));
    std::ranges::fill(out.pixels(), 0u);
    for (const LitTexel& texel : texels_) {
      glm::vec4 colour = colours[texel.joint];
      colour.a *= std::max(coverage(texel.from_bone_mm, width_mm / 2),
                           coverage(texel.from_joint_mm, width_mm));
      out.pixels()[texel.index] = texel_of(colour);
    }
    map_->pad(out);
    return true;
  }

 private:
  static constexpr float kFarthest_mm = 20.5, kFastest_m_s = 1;
  static constexpr int kLevels = 32;  ///< steps of the speed, so that a still hand is still
  static constexpr double kSmoothed_s = 0.1;

  static float coverage(float away_mm, float half_mm) {
    constexpr float kSoft_mm = 0.5;
    return std::clamp((half_mm - away_mm) / kSoft_mm + 0.5f, 0.f, 1.f);
  }

  void find_texels(const renderer::HandMesh& hand) {
    const auto places_mm = rest_positions_mm(hand);
    const glm::mat4 wrist_from_model = glm::inverse(hand.rest[1]);
    std::array<glm::vec2, kJoints> joints_mm;
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      const glm::vec3 place = 1000.f * glm::vec3(wrist_from_model * hand.rest[joint][3]);
      joints_mm[joint] = {place.x, place.z};
    }
    for (const SurfaceTexel& texel : map_->texels()) {
      const glm::vec3 place = texel.of<glm::vec3>(places_mm);
      const auto lit = nearest({place.x, place.z}, joints_mm, texel.index);
      if (std::min(lit.from_bone_mm, lit.from_joint_mm) < kFarthest_mm) texels_.push_back(lit);
    }
  }

  static LitTexel nearest(const glm::vec2& place, const std::array<glm::vec2, kJoints>& joints_mm,
                          std::uint32_t index) {
    LitTexel lit{index, 1, 1e9f, glm::distance(place, joints_mm[1])};
    for (std::size_t joint = 2; joint < kJoints; ++joint) {
      const auto parent = static_cast<std::size_t>(renderer::kJointParent[joint]);
      const float from_bone = from_line_mm(place, joints_mm[parent], joints_mm[joint]);
      if (from_bone < lit.from_bone_mm) {
        lit.from_bone_mm = from_bone;
        lit.joint = static_cast<std::uint8_t>(joint);
      }
      lit.from_joint_mm = std::min(lit.from_joint_mm, glm::distance(place, joints_mm[joint]));
    }
    return lit;
  }

  /// Follows the speeds of the joints. True if a colour changes.
  bool measure(const HandState& hand, double step_s) {
    const bool goes_on = hand.is_there && was_there_ && step_s > 0;
    const auto share = static_cast<float>(1 - std::exp(-step_s / kSmoothed_s));
    bool has_changed = false;
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      const glm::vec3 place = hand.joints_m[joint] - hand.joints_m[1];
      const float speed =
          goes_on ? glm::distance(place, last_m_[joint]) / static_cast<float>(step_s) : 0;
      last_m_[joint] = place;
      speed_m_s_[joint] += share * (speed - speed_m_s_[joint]);
      const int level = std::min(
          kLevels, static_cast<int>(std::lround(kLevels * speed_m_s_[joint] / kFastest_m_s)));
      has_changed = has_changed || level != shown_[joint];
      shown_[joint] = level;
    }
    was_there_ = hand.is_there;
    return has_changed;
  }

  std::shared_ptr<const SurfaceMap> map_;
  std::vector<LitTexel> texels_;
  std::array<glm::vec3, kJoints> last_m_{};  ///< relative to the wrist
  std::array<float, kJoints> speed_m_s_{};
  std::array<int, kJoints> shown_{};  ///< 0..kLevels
  bool was_there_ = false;
};

}  // namespace

Result<std::unique_ptr<Source>> open_skeleton(const Opening& opening) {
  return std::make_unique<SkeletonSource>(opening);
}

}  // namespace handcast::content
