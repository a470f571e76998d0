// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <tuple>

#include "services/lab/simulate/score.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

/// 1.2 s of a rig, which runs once for all tests of this program.
const nlohmann::json& kept_run(const std::string& rig, const std::string& motion,
                               const std::vector<std::string>& settings = {}) {
  static std::map<std::tuple<std::string, std::string, std::vector<std::string>>, nlohmann::json>
      runs;
  auto& run = runs[{rig, motion, settings}];
  if (run.is_null()) run = run_rig(rig, motion, 1.2, settings);
  return run;
}

/// Another person's hand, a network and the errors of a tracker: on the plain twin, whose landmarks
/// are nearly true and whose hand is the drawn one, the paper's steps are as good.
const std::vector<std::string> kStranger{
    "landmarks.backend=handcast",     "twin.shape.mesh=implicit",
    "twin.tracker.offset_mm=12",      "twin.tracker.rotation_deg=4",
    "twin.tracker.joint_offset_mm=3", "twin.tracker.flexion_bias=0.1"};

/// For each motion, the paper's cascade is better than the baseline, and ours is better than the
/// paper's. Percentiles are of the lit points: on a waving hand, 5 % of the surface is dark with
/// the paper's mask, which stays where the camera saw the hand. The baseline is compared by
/// intersection over union and not by coverage: its hand is too large and its spill is up to a
/// fifth of the hand.
class Accuracy : public testing::TestWithParam<std::string> {
 protected:
  static void expect_ordering(const std::string& motion) {
    const auto& baseline = kept_run("baseline", motion, kStranger);
    const auto& paper = kept_run("paper", motion, kStranger);
    const auto& handcast = kept_run("twin", motion, kStranger);
    for (const char* error : {"/interior_mm/mean", "/lit_mm/p95"}) {
      EXPECT_GT(figure(baseline, error), 1.2 * figure(paper, error)) << error;
      EXPECT_GT(figure(paper, error), 1.2 * figure(handcast, error)) << error;
    }
    // Where both are whole, they differ by pixels of the edge.
    constexpr double kTie = 0.002;
    EXPECT_LT(figure(paper, "/coverage"), figure(handcast, "/coverage") + kTie);
    EXPECT_LT(figure(paper, "/iou"), figure(handcast, "/iou") + kTie);
    EXPECT_EQ(handcast.at("foldovers"), 0);
    // Shaken at 1.3 m/s, the paper's mask is as late as the baseline's hand.
    constexpr double kLate = 0.01;
    EXPECT_LT(figure(baseline, "/iou"), figure(paper, "/iou") + kLate);
  }
};

TEST_P(Accuracy, BaselinePaperHandcast) {
  auto motion = GetParam();
  if (!motion.starts_with("builtin:")) {
    motion = (data_root() / "lmc" / motion).string();
    if (!std::filesystem::exists(motion))
      GTEST_SKIP() << "there is no recording " << motion << "; HANDCAST_DATA names another folder";
  }
  expect_ordering(motion);
}

INSTANTIATE_TEST_SUITE_P(Motions, Accuracy,
                         testing::Values("builtin:open_close", "builtin:wave", "builtin:rotate",
                                         "builtin:pinch", "builtin:shake", "builtin:two_hands",
                                         "translation", "rotation", "deformation", "all_5s"),
                         [](const auto& test) {
                           auto name = test.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); },
                               '_');
                           return name;
                         });

/// What is learned of a person must not be what the detector gets wrong of them.
TEST(LongRuns, TheLightOnAStillHandIsAsGoodAfterTwentySeconds) {
  const auto soon = run_rig("twin", "builtin:still", 1.2, kStranger, 24, 1),
             later = run_rig("twin", "builtin:still", 1.2, kStranger, 24, 20);
  EXPECT_LT(figure(later, "/interior_mm/mean"), 1.3 * figure(soon, "/interior_mm/mean"));
}

/// The rigs as they are shipped: real detectors at their ages, and frames that miss refreshes.
TEST(ShippedRigs, OursIsBetterThanThePapersAndThePapersThanTheTrackerAlone) {
  const auto error_mm = [](const std::string& name) {
    const auto rig = config::load_rig(source_root() / ("config/rigs/" + name + ".toml"),
                                      {"twin.motion=builtin:wave"});
    EXPECT_TRUE(rig) << rig.error().what;
    auto options = options_of(name, 1);
    options.draw_every = 24;
    const auto json = score(*rig, calib::reference_rig(), options);
    EXPECT_TRUE(json) << json.error().what;
    return figure(*json, "/interior_mm/mean");
  };
  const double ours = error_mm("twin"), paper = error_mm("paper"), baseline = error_mm("baseline");
  EXPECT_GT(paper, 1.2 * ours);
  EXPECT_GT(baseline, 1.2 * paper);
}

/// What each lever of ours is worth: without it, the error of the light grows by this factor.
struct Lever {
  const char *name, *motion, *without;
  double factor;
};
class EachLever : public testing::TestWithParam<Lever> {};

TEST_P(EachLever, LowersTheError) {
  const Lever lever = GetParam();
  auto settings = kStranger;
  settings.emplace_back(lever.without);
  const auto &with = kept_run("twin", lever.motion, kStranger),
             &without = kept_run("twin", lever.motion, settings);
  EXPECT_GT(figure(without, "/lit_mm/mean"), lever.factor * figure(with, "/lit_mm/mean"));
}

INSTANTIATE_TEST_SUITE_P(
    Cascade, EachLever,
    testing::Values(Lever{"estimate", "builtin:open_close", "cascade.filter.method=paper", 1.2},
                    Lever{"vertices", "builtin:open_close", "cascade.correct.method=grid", 1.05},
                    Lever{"bone_fit", "builtin:open_close", "cascade.skin.fit=false", 1.1},
                    Lever{"outline", "builtin:open_close", "cascade.correct.outline=false", 1.05},
                    Lever{"registration", "builtin:shake", "cascade.register.method=none", 1.05}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(TwoHands, AreNoMoreThanATenthWorseThanOne) {
  const auto& both = kept_run("twin", "builtin:two_hands");
  for (const std::string side : {"left", "right"}) {
    const auto& alone = kept_run("twin", "builtin:two_hands", {"twin.hands=" + side});
    EXPECT_LE(both.at("hands").at(side).at("interior_mm").at("p95").get<double>(),
              1.1 * alone.at("interior_mm").at("p95").get<double>())
        << side;
    EXPECT_GE(both.at("hands").at(side).at("coverage").get<double>(),
              alone.at("coverage").get<double>() - 0.01)
        << side;
  }
}

/// A limitation that the paper states: the drawn hand has not the shape of the person's. Here the
/// bones are fitted to the tracker's joints and the widths to the mask.
TEST(HandShape, FittedToThePersonIsNeverWorseThanTheDefaultOne) {
  for (const std::string person : {"1", "2", "3"})
    for (const std::string spread : {"0", "0.1"}) {
      const std::vector<std::string> hand{"twin.seed=" + person,
                                          "twin.shape.length_spread=" + spread,
                                          "twin.shape.width_spread=" + spread};
      auto stiff = hand;
      stiff.emplace_back("cascade.skin.fit=false");
      const auto fitted_mm =
          run_rig("twin", "builtin:open_close", 1, hand)["interior_mm"]["p95"].get<double>();
      const auto default_mm =
          run_rig("twin", "builtin:open_close", 1, stiff)["interior_mm"]["p95"].get<double>();
      EXPECT_LT(fitted_mm, 0.9 * default_mm) << "person " << person << ", spread " << spread;
    }
}

}  // namespace
}  // namespace handcast::simulate
