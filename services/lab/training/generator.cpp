// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/generator.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace handcast::landmarks::training {

using renderer::JointFrames;

Result<Generator> Generator::create(int people, std::uint64_t seed) {
  auto drawn = draw_people(people, seed);
  if (!drawn) return tl::make_unexpected(drawn.error());
  return Generator(std::move(*drawn), seed);
}

/// Adds a second hand beside the first or over it, in front of it or behind.
void Generator::add_other_hand(Dice& dice, const JointFrames& first, const Light& light) {
  const Person& person = pick_person(dice);
  const Pose pose = draw_pose(dice, person);
  JointFrames joints = moved(draw_view(dice, pose.joints), pose.joints);
  const float angle = dice.between(0, 6.28f), away_m = dice.between(0.03f, 0.17f);
  const glm::vec3 place =
      glm::vec3(first[9][3]) +
      glm::vec3(away_m * std::cos(angle), away_m * std::sin(angle), dice.normal(0.05f));
  scene_.add_hand(dice, person,
                  moved(glm::translate(glm::mat4(1), place - glm::vec3(joints[9][3])), joints),
                  light);
}

void Generator::make_hand(Dice& dice) {
  const Person& person = pick_person(dice);
  const Pose pose = draw_pose(dice, person);
  const JointFrames joints = moved(draw_view(dice, pose.joints), pose.joints);
  sample_.has_tracker = dice.chance(0.65f);
  // Without a tracker, nothing in the image tells another definition from the usual one.
  const Definitions definitions = sample_.has_tracker ? draw_definitions(dice) : Definitions{};
  const JointFrames labelled = defined(joints, definitions);
  const Points truth_px = project(camera_, labelled),
               tracker_px = draw_tracker(dice, camera_, people_, person, pose, joints, definitions);
  sample_.has_hand = 1;
  const Region region = draw_region(dice, truth_px, sample_.has_tracker ? &tracker_px : nullptr);
  sample_.truth = handcast_network::to_places(region, msg::Side::right, truth_px);
  sample_.tracker = handcast_network::to_places(region, msg::Side::right, tracker_px);

  const Light light(dice, glm::vec3(joints[9][3]));
  scene_.clear(region);
  scene_.add_hand(dice, person, joints, light);
  if (dice.chance(0.12f)) add_other_hand(dice, joints, light);
  scene_.draw(dice, light);
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const int joint = msg::kJointOfLandmark[i];
    sample_.visible[i] = scene_.sees(glm::vec3(labelled[joint][3]), person.radius_m[joint]);
  }
}

/// An image without a hand, but often with a forearm; the tracker may still have a hand.
void Generator::make_other(Dice& dice) {
  const Person& person = pick_person(dice);
  const Pose pose = draw_pose(dice, person);
  const JointFrames joints = moved(draw_view(dice, pose.joints), pose.joints);
  Points tracker_px = project(camera_, joints);
  const bool has_arm = dice.chance(0.5f);
  const Region region =
      has_arm ? draw_arm_region(dice, tracker_px) : draw_region(dice, tracker_px, nullptr);
  if (has_arm)
    tracker_px = shifted(tracker_px,
                         region.centre_px - handcast_network::region_around(tracker_px).centre_px);
  sample_.has_hand = 0;
  sample_.has_tracker = dice.chance(has_arm ? 0.25f : 0.5f);
  sample_.tracker = sample_.truth =
      handcast_network::to_places(region, msg::Side::right, tracker_px);
  sample_.visible.fill(0);
  const Light light(dice, glm::vec3(joints[9][3]));
  scene_.clear(region);
  if (has_arm) scene_.add_hand(dice, person, joints, light);
  scene_.draw(dice, light);
}

void Generator::finish(Dice& dice) {
  film_.begin(scene_.grey(), scene_.cover());
  film_.texture(dice);
  film_.background(dice);
  if (dice.chance(0.15f)) film_.leak(dice);
  if (dice.chance(0.05f)) film_.cover(dice);
  film_.blur(dice);
  film_.develop(dice, pixels_);
  const auto shown = handcast_network::shown_values(pixels_);
  for (std::size_t i = 0; i < sample_.image.size(); ++i)
    sample_.image[i] = static_cast<std::uint8_t>(
        std::lround((shown[pixels_[i]] + handcast_network::kShownShift) * Sample::kUnit));
}

const Sample& Generator::make(std::uint64_t number) {
  Dice dice(seed_, number);
  if (dice.chance(0.09f))
    make_other(dice);
  else
    make_hand(dice);
  finish(dice);
  return sample_;
}

}  // namespace handcast::landmarks::training
