// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

/// A stage of the way from exposure to light, in the order in which reports list them.
enum class Stage : std::uint32_t {
  /// The stage of each sensor daemon: camera, pose, landmarks.
  /// @{
  capture,
  sample,
  detect,
  /// @}
  watch,   ///< comparing the tracker with the calibration
  bridge,  ///< a message on its way from another computer
  /// The stages inside one projector frame.
  /// @{
  predict,
  mask,
  registration,
  advance,
  skin,
  correct,
  draw,
  warp,
  fill,
  /// @}
  /// What a GPU did within draw, warp and fill, by its own clock; each ends when the frame is
  /// drawn.
  /// @{
  gpu_draw,
  gpu_warp,
  gpu_upload,
  gpu_fill,
  gpu_read,
  /// @}
  frame,    ///< the whole projector frame in software
  present,  ///< handing the frame to the projector
  light,    ///< from there to the middle of the time it is lit
  count     ///< number of stages
};

/// The names of the stages in reports, in the order of Stage.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(Stage::count)> kStageNames{
    "capture",    "sample",   "detect",   "watch", "bridge",  "predict", "mask",     "register",
    "advance",    "skin",     "correct",  "draw",  "warp",    "fill",    "gpu_draw", "gpu_warp",
    "gpu_upload", "gpu_fill", "gpu_read", "frame", "present", "light"};

/// The time that one stage of one frame took.
struct StageMark {
  Stage stage = Stage::frame;  ///< what was done
  /// By stage: camera_frame.hpp, tracker_faults.hpp (sample), detector_note.hpp (detect),
  /// drift_note.hpp (watch), bridge_note.hpp (bridge), rung.hpp (correct), frame_delay.hpp (frame),
  /// light_source.hpp; else 0.
  std::uint32_t detail = 0;
  /// Begin and end of the stage, CLOCK_MONOTONIC.
  /// @{
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  /// @}
};

/// The stages of one frame in one service.
/// Published by: every service ("marks.<service>", with history).  Read by: the supervisor's
/// recorder, the observer.
struct StageMarks {
  static constexpr std::string_view layout = "StageMarks/7";  ///< see type_hash()

  Header header;               ///< frame_id and origin_ns of the frame
  MadeFrom made_from;          ///< the inputs of a projector frame; zeros in all other frames
  std::uint32_t count = 0;     ///< number of marks
  std::uint32_t reserved = 0;  ///< padding
  std::array<StageMark, 20> marks{};  ///< the first `count` are valid
};

}  // namespace handcast::msg
