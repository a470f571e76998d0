// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "ipc/msg/header.hpp"
#include "ipc/msg/made_from.hpp"

namespace handcast::msg {

/// A step of the way from exposure to photons. The order is the order of the time sheet.
enum class Stage : std::uint32_t {
  capture,
  sample,
  detect,  // one per sensor daemon
  predict,
  mask,
  registration,
  advance,
  skin,
  correct,
  draw,
  warp,
  fill,
  compose,  // inside one projector frame
  frame,
  present,  // the whole frame in software; handing it to the projector
  light,    // from there to the middle of the time it is lit
  count
};

inline constexpr std::array<std::string_view, static_cast<std::size_t>(Stage::count)> kStageNames{
    "capture", "sample", "detect", "predict", "mask",    "register", "advance", "skin",
    "correct", "draw",   "warp",   "fill",    "compose", "frame",    "present", "light"};

struct StageMark {
  Stage stage = Stage::frame;
  std::uint32_t detail = 0;  ///< of `correct`: the rung of each hand (rung.hpp); of others 0
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

/// The stages one service spent on one frame.
/// Published by: every service ("marks.<service>", with history).  Read by: the supervisor's
/// recorder, the observer.
struct StageMarks {
  static constexpr std::string_view layout = "StageMarks/4";

  Header header;
  MadeFrom made_from;  ///< of a projector frame; nothing in all others
  std::uint32_t count = 0;
  std::uint32_t reserved = 0;
  std::array<StageMark, 16> marks{};
};

}  // namespace handcast::msg
