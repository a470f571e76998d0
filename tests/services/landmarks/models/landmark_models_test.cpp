// SPDX-License-Identifier: Apache-2.0
// What every landmark model of the table does.
#include "services/landmarks/models/landmark_models.hpp"

#include <gmock/gmock.h>

#include "services/lab/training/trial.hpp"
#include "services/landmarks/models/models_folder.hpp"
#include "tests/scratch.hpp"
#include "tests/services/landmarks/pictures.hpp"

namespace handcast::landmarks {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using training::Trial;

class EveryModel : public testing::TestWithParam<LandmarkModelRow> {
 protected:
  void SetUp() override {
    if (GetParam().name == "mediapipe") SKIP_WITHOUT_MODELS();
  }
  Result<OpenedModel> open() {
    return open_landmark_model(GetParam().name, {.folder = test::models()});
  }
  /// In the region around the true landmarks.
  static LandmarkEstimate estimate(LandmarkModel& model, const Trial& trial) {
    EstimateTimes times;
    auto estimate = model.estimate(trial.image.view(), model.region_around(trial.truth_px),
                                   trial.side, trial.tracker_px, times);
    EXPECT_TRUE(estimate) << estimate.error().what;
    return estimate.value_or(LandmarkEstimate{});
  }
  static const Trial& trial() {
    static const Trial kTrial = *training::Trials::open("builtin:open_close", 1)->make(1, 10);
    return kTrial;
  }
};
INSTANTIATE_TEST_SUITE_P(, EveryModel,
                         testing::ValuesIn(landmark_models().begin(), landmark_models().end()),
                         [](const auto& named) { return std::string(named.param.name); });

TEST_P(EveryModel, EstimatesAHand) {
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().what;
  const auto hand = estimate(*opened->landmarks, trial());
  EXPECT_GT(hand.presence, 0.9f);
  EXPECT_LT(distance_px(hand.points_px, trial().truth_px),
            0.15f * palm_length_px(trial().truth_px));
}

TEST_P(EveryModel, HasTheTraitsItSays) {
  const auto opened = open();
  ASSERT_TRUE(opened) << opened.error().what;
  LandmarkModel& model = *opened->landmarks;
  const auto traits = model.traits();
  const auto hand = estimate(model, trial());
  EXPECT_EQ(hand.left_score != 0.5f, traits.scores_sides);
  Trial other = trial();
  other.tracker_px = shifted(other.tracker_px, {60, 0});
  const auto elsewhere = estimate(model, other);
  EXPECT_EQ(hand.points_px != elsewhere.points_px, traits.reads_tracker);
  EXPECT_GE(traits.passes_at_first, 1);
}

TEST(ModelsFolder, OneThatIsNamedMustBeThere) {
  const test::Scratch scratch;
  EXPECT_EQ(models_folder(scratch.path().string()).value(), scratch.path());
  const auto missing = models_folder((scratch.path() / "nowhere").string());
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::bad_config);
  EXPECT_THAT(missing.error().what, ::testing::HasSubstr("nowhere: there is no such folder"));
}

TEST(LandmarkModels, AnUnknownOneIsRefusedAndTheKnownOnesAreNamed) {
  const auto opened = open_landmark_model("abacus", {});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, Errc::bad_config);
  EXPECT_THAT(opened.error().what,
              AllOf(HasSubstr("'abacus'"), HasSubstr("there are: handcast, mediapipe")));
}

}  // namespace
}  // namespace handcast::landmarks
