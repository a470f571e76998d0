// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/image_fields.hpp"
#include "calib/solve/lens/auto_capture.hpp"
#include "calib/solve/screen/gray_code.hpp"
#include "calib/solve/screen/screen_fit.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/tools/calibrate/board_watch.hpp"
#include "services/tools/calibrate/pattern_images.hpp"

namespace handcast::calibrate {

/// How the camera sees the projector's light, at its brightest place.
struct LightSeen {
  double contrast = 0;         ///< full light minus none, median, grey levels
  double saturated_share = 0;  ///< of the lit pixels
};

/// Measures by structured light where a board is lit that a person holds at several places. One
/// thread.
class ScreenViews {
 public:
  ScreenViews(Desk& desk, client::Stream<msg::CameraFrame> frames, PatternImages& patterns);

  static constexpr std::size_t kWanted = 5;  ///< views that are enough

  /// Takes a view of each place at which the board is held still, until there are `wanted`, Enter
  /// is pressed or the time is over. Errors: bad_data (there is none, with the reason), those of
  /// the streams and of the rig.
  Result<std::vector<calib::DepthView>> take(std::size_t wanted = kWanted);
  /// Where in the camera's image the views are.
  const calib::ImageFields& seen() const { return seen_; }
  const LightSeen& light() const { return light_; }
  /// How many patterns had to be shown again, and why the last one.
  /// @{
  int repeated() const { return repeated_; }
  const std::string& why_repeated() const { return why_repeated_; }
  /// @}

 private:
  bool is_ready();
  Result<calib::DepthView> measure_twice();
  Result<PatternImages::Image> shoot_one(int pattern);
  Result<void> shoot_pair(int pattern, std::vector<PatternImages::Image>& images);
  Result<std::vector<PatternImages::Image>> shoot();
  void repeat(int pattern, const std::string& why);
  void say_pattern(int pattern);
  calib::GreyView view_of(const PatternImages::Image& image) const;
  Result<calib::DepthView> measure();
  void darken_beside(const glm::dmat4& camera_from_board,
                     std::vector<PatternImages::Image>& images) const;

  Desk& desk_;
  client::Stream<msg::CameraFrame> frames_;
  PatternImages& patterns_;
  BoardWatch board_;
  calib::GrayCode code_;
  calib::AutoCapture capture_;
  calib::ImageFields seen_;
  LightSeen light_;
  std::optional<Progress> progress_;  ///< of take()
  double begun_ = 0, of_each_ = 1;    ///< share of the views that are there, and of each one
  int repeated_ = 0;
  std::string why_repeated_;
};

}  // namespace handcast::calibrate
