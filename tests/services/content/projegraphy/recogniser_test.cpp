// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/recogniser.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "ipc/base/clock.hpp"
#include "tests/services/content/projegraphy/shadow_player.hpp"

namespace handcast::projegraphy {
namespace {

int count() { return static_cast<int>(animals().size()); }
const Animal& animal(int index) { return animals()[static_cast<std::size_t>(index)]; }

/// How many of all animals are recognised when a person holds each of them once.
int recognised_of(ShadowPlayer& player, int take, const Sloppiness& faults, double& most_ms) {
  int right = 0;
  for (int i = 0; i < count(); ++i) {
    player.hold(animal(i), 100 * take + i, faults, take % 2 == 1);
    const auto begin_ns = now_ns();
    const auto found = recogniser().recognise(player.silhouette());
    most_ms = std::max(most_ms, ns_to_ms(now_ns() - begin_ns));
    if (!found) continue;
    right += found->animal == i;
    if (found->animal != i)
      std::printf("  %s is taken for %s\n", animal(i).name.data(),
                  found->animal < 0 ? "none" : animal(found->animal).name.data());
  }
  return right;
}

TEST(Recogniser, KnowsAtLeastTwentyFourAnimalsByTheirNames) {
  EXPECT_GE(count(), 24);
  for (int i = 0; i < count(); ++i) EXPECT_EQ(animal_of(animal(i).name), i);
  EXPECT_EQ(animal_of("unicorn"), -1);
}

// Nothing was tuned on these people and tries; both hands take each part in turn.
TEST(Recogniser, RecognisesTheAnimalsOfOtherPeople) {
  double most_ms = 0;
  int right = 0, all = 0;
  for (const int person : {31, 32, 33, 34, 35}) {
    ShadowPlayer player(person);
    int its = 0;
    for (const int take : {0, 1}) its += recognised_of(player, take, {}, most_ms);
    std::printf("person %d: %.1f %%\n", person, 50. * its / count());
    EXPECT_GE(its, 0.85 * 2 * count()) << person;
    right += its;
    all += 2 * count();
  }
  std::printf("top-1 %.1f %%, at most %.0f ms\n", 100. * right / all, most_ms);
  EXPECT_GE(right, 0.9 * all);
}

// The perspective is another one there.
TEST(Recogniser, RecognisesThemNearerAndAtTheEdgeOfTheLight) {
  int right = 0, all = 0;
  for (const glm::vec3& by_m : {glm::vec3(0, 0, -0.2f), {0.1f, 0.05f, 0}, {-0.12f, -0.04f, 0.2f}}) {
    ShadowPlayer player(38);
    for (int i = 0; i < count(); ++i, ++all) {
      player.hold(animal(i), 300 + i);
      player.move(by_m);
      const auto found = recogniser().recognise(player.silhouette());
      right += found && found->animal == i;
    }
  }
  std::printf("top-1 %.1f %%\n", 100. * right / all);
  EXPECT_GE(right, 0.85 * all);
}

// Twice the spread of people's bones and half as much again of all angles.
TEST(Recogniser, UnusualHandsThatHoldThemBadlyCostLittle) {
  const Sloppiness faults{9, 4.5, 10.5, 18, 0.009};
  double most_ms = 0;
  int right = 0;
  constexpr int kPeople = 3;
  for (int person = 41; person < 41 + kPeople; ++person) {
    ShadowPlayer player(person, {.length_spread = 0.08, .width_spread = 0.12});
    right += recognised_of(player, person % 2, faults, most_ms);
  }
  std::printf("top-1 %.1f %%\n", 100. * right / (kPeople * count()));
  EXPECT_GE(right, 0.8 * kPeople * count());
}

TEST(Recogniser, FindsTheJointsOfTheHandsInTheirSilhouette) {
  ShadowPlayer player(36);
  const auto projector = content::viewer_of(player.calibration());
  for (int i = 0; i < count(); ++i) {
    player.hold(animal(i), i);
    const auto silhouette = player.silhouette();
    const auto found = recogniser().place(silhouette, i);
    ASSERT_TRUE(found);
    // The mirror image of two hands that do the same is the same.
    const bool is_same = found->is_mirrored && animal(i).hands.size() == 2;
    EXPECT_TRUE(is_same || !found->is_mirrored) << animal(i).name;
    ASSERT_EQ(found->joints_px.size(), 26 * animal(i).hands.size());
    float sum = 0;
    for (std::size_t j = 0; j < found->joints_px.size(); ++j) {
      const auto& hand = player.hands()[is_same ? 1 - j / 26 : j / 26];
      sum += glm::distance(found->joints_px[j],
                           silhouette.from_projector(projector.pixel_of(hand.joints_m[j % 26])));
    }
    EXPECT_LT(sum / static_cast<float>(found->joints_px.size()), 0.17f * found->unit_px)
        << animal(i).name;
  }
}

TEST(Recogniser, AnotherHandMakesTheMirrorImage) {
  ShadowPlayer player(0);
  player.hold(animal(animal_of("dog")), 0, {0, 0, 0, 0, 0}, true);
  const auto found = recogniser().recognise(player.silhouette());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->animal, animal_of("dog"));
  EXPECT_TRUE(found->is_mirrored);
}

/// A hand whose fingers are bent and spread by chance, turned somehow.
Animal any_hand(int number) {
  const twin::Random random(900 + number, twin::Stream::tracker_noise);
  const auto spread = [&](std::uint64_t which, double most) {
    return static_cast<float>(most * random.spread(which, 1));
  };
  HeldHand hand;
  for (std::size_t f = 0; f < 5; ++f) {
    const auto bent = static_cast<float>(random.uniform(f));
    hand.flexion[f] = f == 0 ? std::array{36 * bent, 52 * bent, 0.f}
                             : std::array{81 * bent, 103 * bent, 58 * bent};
    hand.splay[f] = spread(f, 12);
  }
  hand.turn = spread(9, 40);
  hand.nod = spread(10, 25);
  hand.spin = spread(11, 45);
  hand.thumb_opposition = spread(12, 15);
  hand.thumb_flexion = spread(13, 10);
  return {"any hand", {hand}};
}

// Those that are seen as animals are often held like one by chance.
TEST(Recogniser, MostHandsThatHoldNoAnimalAreNone) {
  int none = 0, all = 0;
  for (const int person : {31, 32, 33}) {
    ShadowPlayer player(person);
    for (int hand = 0; hand < 40; ++hand, ++all) {
      player.hold(any_hand(hand), 500 + hand);
      none += recogniser().recognise(player.silhouette())->animal < 0;
    }
  }
  std::printf("%.1f %% of %d hands are none\n", 100. * none / all, all);
  EXPECT_GE(none, 0.8 * all);
}

TEST(Recogniser, ThePlaceOfAnAnimalIsFoundOnAnyHand) {
  ShadowPlayer player(31);
  player.hold(any_hand(0), 500);
  const auto silhouette = player.silhouette();
  ASSERT_LT(recogniser().recognise(silhouette)->animal, 0);
  EXPECT_EQ(recogniser().place(silhouette, animal_of("cat"))->animal, animal_of("cat"));
}

TEST(Recogniser, NothingIsNoAnimal) {
  EXPECT_FALSE(recogniser().recognise({}));
  EXPECT_FALSE(recogniser().recognise(silhouette_of({})));
  FlatHand flat{&content::made_hand(content::Side::left), {}};
  flat.px.resize(flat.mesh->vertex_count(), glm::vec2(NAN));
  EXPECT_FALSE(recogniser().recognise(silhouette_of({&flat, 1})));
}

}  // namespace
}  // namespace handcast::projegraphy
