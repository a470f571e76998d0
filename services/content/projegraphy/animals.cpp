// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/animals.hpp"

namespace handcast::projegraphy {
namespace {

using Finger = std::array<float, 3>;

constexpr Finger kStraight{-3, -5, -3}, kShut{78, 98, 55};
constexpr Finger kThumbOpen{-5, -8, 0}, kThumbShut{36, 52, 0};

/// A hand with these fingers, from the thumb to the little one.
HeldHand held(std::array<Finger, 5> flexion, std::array<float, 5> splay = {}) {
  HeldHand hand;
  hand.flexion = flexion;
  hand.splay = splay;
  return hand;
}
/// Fingers side by side, and spread.
constexpr std::array<float, 5> kClosed{0, -10, -2, 7, 18}, kSpread{0, 9, 3, -6, -9};

HeldHand with_thumb(HeldHand hand, float flexion, float opposition) {
  hand.thumb_flexion = flexion;
  hand.thumb_opposition = opposition;
  return hand;
}
HeldHand seen(HeldHand hand, float turn, float nod, float spin, glm::vec2 wrist_m = {0, 0}) {
  hand.turn = turn;
  hand.nod = nod;
  hand.spin = spin;
  hand.wrist_m = wrist_m;
  return hand;
}
/// The thumb in front of shut fingers.
HeldHand thumb_shut(const HeldHand& hand) { return with_thumb(hand, 14, 18); }
/// The right hand as the mirror image of the left one.
std::vector<HeldHand> with_mirror_image(const HeldHand& left) {
  HeldHand right = left;
  right.spin = -left.spin;
  right.wrist_m.x = -left.wrist_m.x;
  return {left, right};
}

std::vector<Animal> all() {
  const auto flat = held({kThumbOpen, kStraight, kStraight, kStraight, kStraight}, kClosed);
  const auto fist = thumb_shut(held({kThumbShut, kShut, kShut, kShut, kShut}));
  const auto open = held({kThumbOpen, kStraight, kStraight, kStraight, kStraight}, kSpread);
  const auto ring = with_thumb(
      held({Finger{30, 35, 0}, Finger{48, 58, 35}, kStraight, kStraight, kStraight}, kSpread), 8,
      22);
  auto dog = with_thumb(flat, 0, -30);
  dog.splay[4] = -26;
  return {
      {"dog", {seen(dog, 0, 0, -90)}, 0.123f},
      {"horse", {seen(with_thumb(flat, 0, -30), 0, 0, -90)}, 0.116f},
      {"fish",
       {seen(with_thumb(
                 held({Finger{10, 10, 0}, kStraight, kStraight, kStraight, kStraight}, kClosed), 10,
                 28),
             0, 0, -90)},
       0.102f},
      {"wolf",
       {seen(with_thumb(held({Finger{10, 10, 0}, kStraight, Finger{68, 14, 5}, Finger{70, 12, 5},
                              kStraight}),
                        10, 28),
             62, 0, 0)},
       0.211f},
      {"rabbit",
       {seen(thumb_shut(held({kThumbShut, kStraight, kStraight, kShut, kShut}, {0, 8, -8, 0, 0})),
             0, 0, 0)},
       0.081f},
      {"giraffe",
       {seen(thumb_shut(held({kThumbShut, kStraight, kStraight, kShut, kShut}, {0, -8, 2, 0, 0})),
             0, 0, 0)},
       0.09f},
      {"cat",
       {seen(thumb_shut(held({kThumbShut, Finger{5, 95, 60}, kShut, kShut, Finger{5, 95, 60}},
                             {0, 6, 0, 0, -8})),
             0, 0, 0)},
       0.053f},
      {"bear", {seen(fist, 0, 0, 0)}, 0.053f},
      {"mouse",
       {seen(thumb_shut(held({kThumbShut, kShut, kShut, kShut, kStraight}, {0, 0, 0, 0, -12})), 0,
             0, 60)},
       0.078f},
      {"deer",
       {seen(with_thumb(held({kThumbOpen, kStraight, kShut, kShut, kStraight}, {0, 6, 0, 0, -10}),
                        0, -22),
             0, 0, 0)},
       0.157f},
      {"bull",
       {seen(with_thumb(held({kThumbOpen, kShut, kShut, kShut, kStraight}, {0, 0, 0, 0, -22}), 0,
                        -30),
             0, 0, 0)},
       0.147f},
      {"turtle",
       {seen(with_thumb(held({kThumbOpen, kShut, kShut, kShut, kShut}), 0, -28), 0, 0, -60)},
       0.112f},
      {"rooster", {seen(ring, 25, 0, 0)}, 0.163f},
      {"peacock", {seen(with_thumb(open, 0, -14), 0, 0, 0)}, 0.135f},
      {"octopus",
       {seen(with_thumb(held({kThumbOpen, Finger{15, 35, 20}, Finger{15, 35, 20},
                              Finger{15, 35, 20}, Finger{15, 35, 20}},
                             kSpread),
                        0, -10),
             0, 0, 180)},
       0.142f},
      {"elephant",
       {seen(with_thumb(held({kThumbOpen, Finger{25, 95, 45}, kStraight, Finger{25, 95, 45},
                              Finger{10, 10, 5}},
                             {0, 4, 0, -4, -16}),
                        0, -26),
             0, 0, 180)},
       0.138f},
      {"crocodile",
       {seen(with_thumb(held({Finger{-8, -5, 0}, Finger{-18, 4, 2}, Finger{-18, 4, 2},
                              Finger{-18, 4, 2}, Finger{-18, 4, 2}},
                             kClosed),
                        32, 0),
             90, 0, 90)},
       0.195f},
      {"duck",
       {seen(with_thumb(held({Finger{10, 10, 0}, Finger{62, 12, 5}, Finger{62, 12, 5},
                              Finger{62, 12, 5}, Finger{62, 12, 5}},
                             kClosed),
                        4, 30),
             90, 0, 0)},
       0.172f},
      {"swan",
       {seen(with_thumb(held({Finger{20, 20, 0}, Finger{88, 35, 12}, Finger{88, 35, 12},
                              Finger{88, 35, 12}, Finger{88, 35, 12}},
                             kClosed),
                        14, 34),
             90, 0, 0)},
       0.159f},
      {"cobra",
       {seen(with_thumb(held({Finger{20, 25, 0}, Finger{12, 62, 42}, Finger{12, 62, 42},
                              Finger{12, 62, 42}, Finger{12, 62, 42}},
                             kClosed),
                        -22, 34),
             90, 0, 0)},
       0.125f},
      {"eagle", with_mirror_image(seen(with_thumb(flat, 0, -24), 0, 0, -58, {-0.012f, 0})), 0.134f},
      {"butterfly", with_mirror_image(seen(with_thumb(open, 0, -14), 0, 0, -22, {-0.058f, 0})),
       0.173f},
      {"spider",
       with_mirror_image(seen(with_thumb(held({kThumbOpen, Finger{8, 30, 15}, Finger{8, 30, 15},
                                               Finger{8, 30, 15}, Finger{8, 30, 15}},
                                              {0, 12, 4, -8, -14}),
                                         0, -30),
                              0, 0, -90, {0.02f, 0})),
       0.142f},
      {"owl", with_mirror_image(seen(ring, -25, 0, 8, {-0.05f, 0})), 0.209f},
      {"crab",
       with_mirror_image(seen(
           with_thumb(
               held({kThumbOpen, kStraight, kStraight, kStraight, kStraight}, {0, 4, 10, -14, -6}),
               0, -14),
           0, 0, -62, {-0.012f, 0})),
       0.142f},
      {"snail",
       {seen(fist, 0, 0, 0, {0.03f, 0}),
        seen(thumb_shut(held({kThumbShut, kStraight, kStraight, kShut, kShut}, {0, 8, -8, 0, 0})),
             0, 0, -90, {0.09f, 0.02f})},
       0.133f},
  };
}

}  // namespace

std::span<const Animal> animals() {
  static const std::vector<Animal> kAll = all();
  return kAll;
}

int animal_of(std::string_view name) {
  const auto known = animals();
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i].name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace handcast::projegraphy
