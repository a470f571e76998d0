// SPDX-License-Identifier: Apache-2.0
// Rigs without a tracker (pose.backend "none"), compared with the full rig: whole runs in virtual
// time. The limits are measured figures with a margin.
#include <gtest/gtest.h>

#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

using Settings = std::vector<std::string>;

nlohmann::json without_tracker(const std::string& motion, double seconds, Settings settings = {}) {
  settings.insert(settings.end(), {"pose.backend=none", "twin.detector.age_ms=5"});
  return run_rig("twin", "builtin:" + motion, seconds, settings);
}
double interior_mm(const nlohmann::json& json) { return figure(json, "/interior_mm/mean"); }

TEST(NoTracker, TheLandmarksAloneLightAHand) {
  for (const auto* motion : {"open_close", "shake", "two_hands"}) {
    const auto json = without_tracker(motion, 0.6);
    EXPECT_LT(interior_mm(json), 2) << motion;
    EXPECT_GT(json["coverage"], 0.97) << motion;
  }
}

TEST(NoTracker, TheLightOnAStillHandTremblesByAboutAPixel) {
  const auto json = run_rig("twin", "builtin:still", 1,
                            {"pose.backend=none", "twin.detector.age_ms=5"}, /*draw_every=*/12);
  EXPECT_LT(figure(json, "/jitter_px"), 1.3) << "the goal is 0.5";
}

TEST(NoTracker, NothingOfTheTrackerIsUsed) {
  const Settings blind{"twin.tracker.dropout=1"};
  EXPECT_EQ(without_tracker("wave", 0.3)["interior_mm"],
            without_tracker("wave", 0.3, blind)["interior_mm"]);
}

TEST(NoTracker, ADistanceThatIsWrongBy10CmDoesNotMoveTheLight) {
  const double right_mm = interior_mm(without_tracker("wave", 0.4));
  for (const auto* setting : {"pose.none.distance_m=0.63", "pose.none.distance_m=0.83"})
    EXPECT_LT(interior_mm(without_tracker("wave", 0.4, {setting})), right_mm + 0.3) << setting;
}

TEST(NoTracker, NoiseOfThreePixelsIsBorne) {
  EXPECT_LT(interior_mm(without_tracker("wave", 0.4, {"twin.detector.noise_px=3"})), 4.2);
}

TEST(NoTracker, TheNetworkFindsAndFollowsTheHandByItself) {
  const test::Scratch no_models;
  const Settings network{"landmarks.backend=handcast",
                         "landmarks.models=" + no_models.path().string()};
  const auto json = without_tracker("pinch", 0.4, network);
  EXPECT_LT(interior_mm(json), 2.8);
  EXPECT_GT(json["coverage"], 0.97);
  EXPECT_EQ(json["detector"]["missed"], 0);
}

TEST(NoTracker, InADarkImageTheNetworkStillFindsTheHand) {
  const test::Scratch no_models;
  const auto json = without_tracker("wave", 0.3,
                                    {"landmarks.backend=handcast", "twin.image.dark=0.25",
                                     "landmarks.models=" + no_models.path().string()});
  EXPECT_LT(interior_mm(json), 3);
  EXPECT_EQ(json["detector"]["missed"], 0);
}

/// What the network finds by itself in 0.3 s after `warm_up_s`.
nlohmann::json found_after(double warm_up_s, const std::string& motion) {
  const test::Scratch no_models, folder;
  Options options = options_of("twin", 0.3);
  add_settings(options,
               {"landmarks.backend=handcast", "pose.backend=none", "twin.detector.age_ms=5",
                "landmarks.models=" + no_models.path().string()});
  options.settings.push_back("twin.motion=builtin:" + motion);
  options.draw_every = 0;
  options.warm_up_s = warm_up_s;
  options.json_file = (folder.path() / "metrics.json").string();
  EXPECT_TRUE(run(options));
  return nlohmann::json::parse(std::ifstream(options.json_file))["detector"];
}

TEST(NoTracker, CrossingHandsKeepTheirSides) {
  EXPECT_LT(found_after(0.75, "crossing")["error_px"]["p50"], 10) << "after they have crossed";
}

TEST(NoTracker, AHandThatHadNoClearSideIsFoundWhenItTurns) {
  EXPECT_EQ(found_after(1.25, "point_at_camera")["missed"], 0);
}

}  // namespace
}  // namespace handcast::simulate
