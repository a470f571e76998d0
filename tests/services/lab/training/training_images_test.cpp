// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "services/lab/training/generator.hpp"

namespace handcast::landmarks::training {
namespace {

constexpr std::uint64_t kSeed = 77;

/// Making people takes time: these tests share some.
const std::vector<Person>& people() {
  static const auto drawn = draw_people(3, kSeed);
  EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().what);
  return *drawn;
}

Generator& generator() {
  static auto made = Generator::create(3, kSeed);
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *made;
}

bool equal(const Sample& a, const Sample& b) { return std::memcmp(&a, &b, sizeof(Sample)) == 0; }

TEST(TrainingImages, ANumberIsAlwaysTheSameImageWhateverWasMadeBefore) {
  const Sample first = generator().make(5);
  generator().make(6);
  auto other = Generator::create(3, kSeed);
  ASSERT_TRUE(other);
  other->make(900);
  EXPECT_TRUE(equal(first, other->make(5)));
  EXPECT_FALSE(equal(first, other->make(6)));
}

TEST(TrainingImages, AnotherSeedMakesOtherImages) {
  auto other = Generator::create(3, kSeed + 1);
  ASSERT_TRUE(other);
  EXPECT_FALSE(equal(generator().make(5), other->make(5)));
}

/// The middle of what the scene covers, in image px.
glm::vec2 middle_of_cover(const Scene& scene, const Region& region) {
  glm::vec2 sum(0);
  float weight = 0;
  for (int y = 0; y < handcast_network::kSide_px; ++y)
    for (int x = 0; x < handcast_network::kSide_px; ++x) {
      const float cover = scene.cover()[y * handcast_network::kSide_px + x];
      sum += cover *
             ((glm::vec2(x, y) + 0.5f) / static_cast<float>(handcast_network::kSide_px) - 0.5f);
      weight += cover;
    }
  return region.to_image(sum / weight);
}

/// A hand far away, seen with all of its arm.
glm::vec2 middle_of_far_hand(const Region& region) {
  Dice dice(1, 2);
  const Pose pose = pose_of(people()[0], {});
  const auto joints =
      moved(glm::mat4(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 2, 1), pose.joints);
  const Light light(dice, {0, 0, 2});
  Scene scene(calib::CameraModel{}, region);
  scene.add_hand(dice, people()[0], joints, light);
  scene.draw(dice, light);
  return middle_of_cover(scene, region);
}

TEST(TrainingImages, AHandIsDrawnAtTheSamePixelHoweverTheRegionIsTurned) {
  const glm::vec2 upright = middle_of_far_hand({{360, 290}, 500, 0}),
                  over = middle_of_far_hand({{360, 290}, 500, 3.1415927f});
  EXPECT_LT(glm::distance(upright, over),
            0.25f);  // half a pixel of the crop is 2.6 px here, and shows twice
}

TEST(TrainingImages, LabelsLieOnTheHand) {
  const calib::CameraModel camera;
  int on_hand = 0, all = 0;
  for (std::uint64_t n = 0; n < 40; ++n) {
    Dice dice(kSeed, n);
    const Person& person = people()[n % people().size()];
    const Pose pose = draw_pose(dice, person);
    const auto joints = moved(draw_view(dice, pose.joints), pose.joints);
    const Points truth_px = project(camera, joints);
    const Region region = handcast_network::region_around(truth_px);
    const Light light(dice, glm::vec3(joints[9][3]));
    Scene scene(camera, region);
    scene.add_hand(dice, person, joints, light);
    scene.draw(dice, light);
    const handcast_network::Places places =
        handcast_network::to_places(region, msg::Side::right, truth_px);
    for (int i = 0; i < msg::kLandmarks; ++i) {
      if (i > 0 && i % 4 == 0) continue;  // tips lie on the outline
      const glm::ivec2 px = glm::clamp(glm::ivec2(places[i] * float(handcast_network::kSide_px)), 0,
                                       handcast_network::kSide_px - 1);
      on_hand += scene.cover()[px.y * handcast_network::kSide_px + px.x] > 0;
      ++all;
    }
  }
  EXPECT_GT(on_hand, 0.99 * all);
}

TEST(TrainingImages, AForearmIsShownWithoutItsFingers) {
  const calib::CameraModel camera;
  int with_arm = 0;
  for (std::uint64_t n = 0; n < 40; ++n) {
    Dice dice(kSeed, n);
    const Person& person = people()[n % people().size()];
    const Pose pose = draw_pose(dice, person);
    const auto joints = moved(draw_view(dice, pose.joints), pose.joints);
    const Points hand_px = project(camera, joints);
    const Region region = draw_arm_region(dice, hand_px);
    const auto places = handcast_network::to_places(region, msg::Side::right, hand_px);
    for (int i = 1; i < msg::kLandmarks; ++i)
      EXPECT_TRUE(glm::any(glm::lessThan(places[i], glm::vec2(0))) ||
                  glm::any(glm::greaterThan(places[i], glm::vec2(1))))
          << "hand " << n << ", landmark " << i;
    const Light light(dice, glm::vec3(joints[9][3]));
    Scene scene(camera, region);
    scene.add_hand(dice, person, joints, light);
    scene.draw(dice, light);
    with_arm += std::ranges::any_of(scene.cover(), [](float cover) { return cover > 0.5f; });
  }
  EXPECT_GT(with_arm, 30);
}

TEST(TrainingImages, NoFingerIsInsideAnother) {
  for (std::uint64_t n = 0; n < 300; ++n) {
    Dice dice(kSeed, n);
    const Person& person = people()[n % people().size()];
    ASSERT_FALSE(penetrates(person, draw_pose(dice, person).joints)) << "pose " << n;
  }
}

TEST(TrainingImages, AFingerThroughThePalmOrThroughItsNeighbourIsSeen) {
  const Person& person = people()[0];
  EXPECT_FALSE(penetrates(person, pose_of(person, {}).joints));
  twin::Bend through_palm;
  through_palm.flexion[2] = {1.9, 2.2, 0.2};
  EXPECT_TRUE(penetrates(person, pose_of(person, {through_palm}).joints));
  twin::Bend through_neighbour;
  through_neighbour.splay[2] = 0.2;
  through_neighbour.splay[1] = -0.15;
  EXPECT_TRUE(penetrates(person, pose_of(person, {through_neighbour}).joints));
}

TEST(TrainingImages, FingersAreOpenAndFoldedAlike) {
  int folded = 0, all = 0;
  for (std::uint64_t n = 0; n < 300; ++n) {
    Dice dice(kSeed, n);
    const twin::Bend bend = draw_pose(dice, people()[0]).posture.bend;
    for (int finger = 1; finger < 5; ++finger, ++all) folded += bend.flexion[finger][1] > 0.9;
  }
  EXPECT_GT(folded, 0.25 * all);
  EXPECT_LT(folded, 0.75 * all);
}

TEST(TrainingImages, TheTrackerIsThereInTwoThirdsAndOffByAFifthOfThePalm) {
  int with_tracker = 0, hands = 0;
  std::vector<float> off;
  for (std::uint64_t n = 0; n < 400; ++n) {
    const Sample& sample = generator().make(n);
    hands += sample.has_hand;
    with_tracker += sample.has_hand && sample.has_tracker;
    const float palm = glm::distance(sample.truth[0], sample.truth[9]);
    if (sample.has_hand && sample.has_tracker)
      off.push_back(distance_px(sample.truth, sample.tracker) / palm);
  }
  EXPECT_NEAR(static_cast<double>(with_tracker) / hands, 0.65, 0.07);
  std::ranges::nth_element(off, off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2));
  EXPECT_NEAR(off[off.size() / 2], 0.25, 0.1);
}

TEST(TrainingImages, SomeJointsAreHiddenMostAreNot) {
  int visible = 0, all = 0;
  for (std::uint64_t n = 0; n < 100; ++n) {
    const Sample& sample = generator().make(n);
    if (!sample.has_hand) continue;
    all += msg::kLandmarks;
    visible += static_cast<int>(std::ranges::count(sample.visible, 1));
  }
  EXPECT_GT(visible, 0.5 * all);
  EXPECT_LT(visible, 0.95 * all);
}

}  // namespace
}  // namespace handcast::landmarks::training
