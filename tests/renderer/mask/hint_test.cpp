// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/hint.hpp"

#include <gtest/gtest.h>

#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

TEST(Hint, AHandFarOutsideTheImageIsNotLookedForEvenWhereTheLensWouldFoldItIn) {
  auto calibration = rig_above_hand();
  calibration.camera.k1 = -0.8;  // the polynomial turns back outside the image
  calibration.camera.k2 = calibration.camera.k3 = 0;
  ASSERT_FALSE(calibration.camera.folds());
  const auto hint_at = [&](float x_m) {
    return make_hint(calibration, {}, *project(calibration, pose_of(Side::left, {x_m, 0, 0})), {},
                     false);
  };
  EXPECT_TRUE(hint_at(0));
  EXPECT_TRUE(hint_at(0.2f));    // partly in the image
  EXPECT_FALSE(hint_at(0.55f));  // the polynomial maps it into the image
}

}  // namespace
}  // namespace handcast::renderer
