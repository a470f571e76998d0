// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "services/tools/calibrate/desk.hpp"

/// A projector that a person aligns, because the camera does not see its light.
namespace handcast::calibrate {

/// Where the corners of the camera's image, a tenth of its size from its edges, are put in the
/// projector's image by a person (the paper's four-corner alignment).
class DraggedCorners {
 public:
  /// Begins with the draft's homography.
  explicit DraggedCorners(const calib::Calibration& draft);

  /// Obeys a key: 1 to 4 choose a corner, arrows move it, + and - change the step. False if the key
  /// means nothing.
  bool press(const Key& key);
  /// Chooses the corner at a place in the projector's image, to be dragged; false if there is none
  /// within kReach_px.
  bool grab(const glm::dvec2& projector_px);
  /// Moves the corner that was grabbed, until drop(); without one, does nothing.
  void drag_to(const glm::dvec2& projector_px);
  void drop() { is_held_ = false; }
  /// The homography that puts the corners there: undistorted camera px to projector px.
  glm::dmat3 homography() const;
  /// What the keys do now: "corner 2 (top right), steps of 5 px".
  std::string state() const;
  /// The chosen corner, projector px.
  const glm::dvec2& chosen_px() const { return projector_px_[chosen_]; }
  /// All corners, projector px, clockwise from the top left.
  const std::array<glm::dvec2, 4>& corners_px() const { return projector_px_; }

  static constexpr double kReach_px = 60;

 private:
  std::array<glm::dvec2, 4> camera_px_{}, projector_px_{};  ///< clockwise from the top left
  std::size_t chosen_ = 0;
  double step_px_ = 5;
  bool is_held_ = false;
  glm::dvec2 held_off_px_{0};  ///< from the mouse to the corner that it holds
};

/// What a person does with the left button of the mouse, in projector pixels.
struct Grip {
  enum class Kind { press, move, release };
  Kind kind = Kind::move;
  glm::dvec2 px{0};
};

/// A window on the operator's monitor with the picture that the projector shows, in which corners
/// are dragged. The projector's own output takes no mouse: it may have no window system, and
/// belongs to another process. Used by the main thread; only one.
class DragWindow {
 public:
  virtual ~DragWindow() = default;

  /// Shows a picture: levels row by row, of the size that the window was opened with. Errors: those
  /// of renderer::Window::show().
  virtual Result<void> show(const std::vector<std::uint8_t>& levels) = 0;
  /// What the mouse has done since the last call.
  virtual std::vector<Grip> take_grips() = 0;
};

/// Opens it for pictures of the projector's size; it is shown at half of it.
/// `when_display_is_lost`: called once before the process ends. Errors: unavailable (no display),
/// bad_config (this build has no windows).
Result<std::unique_ptr<DragWindow>> open_drag_window(int width_px, int height_px,
                                                     std::function<void()> when_display_is_lost);

/// Aligns a coaxial projector by hand, for a camera that does not see its light: the camera's image
/// is projected, and a person drags its corners until it falls onto the things that it shows: with
/// the arrow keys in the terminal, or with the mouse in a window (see DragWindow). Sets
/// draft.projector.from_camera. Errors: bad_config (nobody is at the terminal), those of the
/// streams.
Result<Outcome> align_by_hand(Desk& desk);

}  // namespace handcast::calibrate
