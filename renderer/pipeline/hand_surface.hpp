#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/cascade/untangle.hpp"
#include "renderer/hand/bone_fit.hpp"
#include "renderer/painter.hpp"
#include "renderer/pipeline/width_meter.hpp"

namespace handcast::renderer {

/// The skin of one hand: its mesh without what lies beyond the wrist's cut, its texture, and the buffers a frame fills.
class HandSurface {
 public:
  /// Errors: bad_config (no such file, no such content).
  static Result<HandSurface> load(Side side, const std::filesystem::path& hand_file, const std::string& content, double forearm_mm);

  /// A tracker sample, to know the person by.
  void learn(std::int64_t origin_ns, const msg::HandPose& pose) { bone_fit_->learn(origin_ns, frames_of(pose)); }

  /// Skins the mesh and sees it through the camera and the projector. `shading` 0..1; light comes from the camera's side. All light is
  /// multiplied by `presence` 0..1.
  void pose(const msg::HandPose& pose, const config::Skin& settings, const calib::Calibration& calibration, float shading,
            float presence = 1);

  /// The mask of this hand (projector px) at the time its landings are for, to know the person's widths by.
  void learn_widths(std::int64_t time_ns, const LandmarkPoints& landmarks_px, GreyView mask);

  const HandMesh& mesh() const { return mesh_; }
  std::span<const glm::vec2> seen_px() const { return seen_px_; }  ///< projector px, as the tracker has it
  std::span<glm::vec2> landings_px() { return landings_px_; }      ///< the same after pose(); for the correction to move
  std::span<const glm::vec2> landings_px() const { return landings_px_; }
  DrawnHand drawn(std::span<const glm::vec2> position_px) const;

  /// Bounds of the drawn triangles' vertices, whole pixels.
  Rect bounds(std::span<const glm::vec2> position_px) const;
  /// After a correction has moved the landings: turns back drawn triangles that faced the camera and were turned over. Returns how
  /// many stay so.
  int untangle() { return untangler_->untangle(seen_px_, landings_px_, facing_sign_); }

 private:
  HandMesh mesh_;
  Texture texture_;
  std::optional<BoneFit> bone_fit_;
  std::optional<WidthMeter> width_meter_;
  std::optional<Untangler> untangler_;
  std::vector<std::uint16_t> drawn_vertices_;
  std::vector<glm::vec3> positions_m_, normals_;
  std::vector<glm::vec2> seen_px_, landings_px_;
  std::vector<float> depth_m_, light_;
  bool lit_evenly_ = true;  ///< and fully: light_ is not used
  float facing_sign_ = -1;  ///< of the projected area of a triangle that faces the camera
};

}  // namespace handcast::renderer
