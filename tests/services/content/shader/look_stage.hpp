// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include "services/content/shader/graphics.hpp"
#include "tests/services/content/gesturing_hands.hpp"
#include "tests/services/content/made_hand.hpp"

namespace handcast::content {

/// Draws looks on hands that move as in one of the twin's motions. Skipped without OpenGL.
class LookStage : public testing::Test {
 protected:
  void SetUp() override {
    auto graphics = shader::Graphics::open();
    if (!graphics) GTEST_SKIP() << "no OpenGL here: " << graphics.error().what;
    graphics_ = std::move(*graphics);
  }

  /// The hands at a time of a motion, with surfaces.
  const BothHands& pose(std::string_view motion, double seconds) {
    const GesturingHands gesturing(motion);
    followed_.emplace(*Hands::load({}, gesturing.calibration()));
    followed_->needs_surface(true);
    gesturing.follow(*followed_, seconds);
    both_ = followed_->at(GesturingHands::ns(seconds));
    return both_;
  }
  /// A moment of the last pose.
  Moment moment(Side side, double time_s, std::uint64_t frame) const {
    Moment now;
    now.time_s = now.day_s = time_s;
    now.step_s = 1. / 30;
    now.frame = frame;
    now.hand = &both_[static_cast<std::size_t>(side)];
    now.other = &both_[1 - static_cast<std::size_t>(side)];
    return now;
  }

  BothHands both_;
  std::optional<Hands> followed_;

 private:
  std::shared_ptr<shader::Graphics> graphics_;  // made once for all looks of a test
};

}  // namespace handcast::content
