// SPDX-License-Identifier: Apache-2.0
#include "services/lab/perception/viewer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "services/studies/jnd/stimulus.hpp"
#include "services/studies/jnd/subjects.hpp"

namespace handcast::perception {
namespace {

const std::vector<double> kUsual{3, 8, 12, 17, 25};

TEST(Viewer, TheFillHidesDelaysBecauseTheEdgesAreGone) {
  const double edges = jnd_ms(kUsual, {.edges = 1}), half = jnd_ms(kUsual, {.edges = 0.5}),
               none = jnd_ms(kUsual, {.edges = 0});
  EXPECT_LT(edges, half);
  EXPECT_LT(half, none);
  EXPECT_GT(none / edges, 1.5);
}

TEST(Viewer, TheOrderOfThePaperFollowsWhateverTheSkinsContrast) {
  for (const double contrast : {0.01, 0.03, 0.1, 0.2})
    EXPECT_LT(jnd_ms(kUsual, {.edges = 1, .skin_contrast = contrast}),
              jnd_ms(kUsual, {.edges = 0, .skin_contrast = contrast}));
}

TEST(Viewer, SlowHandsHideMoreAndStillOnesAll) {
  EXPECT_GT(jnd_ms(std::vector{0.5}, {}), jnd_ms(std::vector{5.0}, {}));
  EXPECT_TRUE(std::isinf(jnd_ms(std::vector{0.0, 0.0}, {})));
  EXPECT_TRUE(std::isinf(jnd_ms({}, {})));
  EXPECT_TRUE(std::isinf(jnd_ms(kUsual, {.edges = 0, .skin_contrast = 0})));
}

TEST(Viewer, ThreeOfFourAnswersAreRightAtTheJnd) {
  EXPECT_NEAR(picks_late(5, 5), 0.75, 1e-6);
  EXPECT_NEAR(picks_late(0, 5), 0.5, 1e-9);
  EXPECT_NEAR(picks_late(100, 5, 0.1), 0.95, 1e-6);
}

// The one constant of the model was fitted to the first figure; the second is a prediction.
TEST(Viewer, OnTheAuthorsRecordingThePapersMeansComeOut) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto motion = std::filesystem::path(data ? data : "../shared/data") / "lmc/all_5s";
  if (!std::filesystem::exists(motion)) GTEST_SKIP() << motion << " is not there";
  study::StimulusSettings settings;
  settings.motion = motion.string();
  const auto stimulus = study::Stimulus::open(settings);
  ASSERT_TRUE(stimulus) << stimulus.error().what;
  const auto jnds_ms = study::predicted_jnds_ms(stimulus->speeds_deg_s(0, 5));
  EXPECT_NEAR(jnds_ms[0], 3.08, 0.1);
  EXPECT_NEAR(jnds_ms[1], 6.62, 1);
}

}  // namespace
}  // namespace handcast::perception
