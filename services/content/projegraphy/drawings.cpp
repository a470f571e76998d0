// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/drawing.hpp"

namespace handcast::projegraphy {
namespace {

using enum Pattern;

// Joints: palm, wrist, and of each finger the knuckle (0), the next two joints, and the tip (3).
constexpr int P = 0, W = 1, T1 = 3, T2 = 4, T3 = 5, I0 = 7, I1 = 8, I2 = 9, I3 = 10, M0 = 12,
              M1 = 13, M2 = 14, M3 = 15, R0 = 17, R1 = 18, R2 = 19, R3 = 20, L0 = 22, L1 = 23,
              L2 = 24, L3 = 25;
/// A joint of the right hand.
constexpr int right(int joint) { return joint + 26; }

Mark limb(Spot from, Spot to, float r0, float r1, std::uint32_t colour, Pattern pattern = plain) {
  return {Mark::Kind::limb, from, to, from, r0, r1, colour, pattern};
}
Mark eye(Spot at, float r, std::uint32_t iris) {
  return {Mark::Kind::eye, at, at, at, r, r, iris, plain};
}
Mark slit(Spot at, float r, std::uint32_t iris) {
  return {Mark::Kind::slit, at, at, at, r, r, iris, plain};
}
Mark disc(Spot at, float r, std::uint32_t colour) {
  return {Mark::Kind::disc, at, at, at, r, r, colour, plain};
}
Mark line(Spot from, Spot by, Spot to, float width, std::uint32_t colour = 0x201008) {
  return {Mark::Kind::line, from, to, by, width, width, colour, plain};
}
Mark spiral(Spot at, float r, std::uint32_t colour) {
  return {Mark::Kind::spiral, at, at, at, r, r, colour, plain};
}

/// The same on both hands.
std::vector<Mark> on_both(std::vector<Mark> marks) {
  const auto count = marks.size();
  for (std::size_t i = 0; i < count; ++i) {
    Mark other = marks[i];
    for (Spot* spot : {&other.from, &other.to, &other.by}) {
      spot->a += 26;
      spot->b += 26;
      spot->side = -spot->side;
    }
    marks.push_back(other);
  }
  return marks;
}
std::vector<Mark> together(std::vector<Mark> all, const std::vector<Mark>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Nose, mouth and whiskers of a face that looks at us, from the knuckles down; `aside` of the
/// middle finger.
std::vector<Mark> face(float aside, float nose, std::uint32_t nose_colour, std::uint32_t whiskers) {
  const auto at = [&](float down, float side) { return Spot(M0, W, nose + down, aside + side); };
  std::vector<Mark> marks{line(at(0.13f, 0), at(0.27f, 0.08f), at(0.13f, 0.17f), 0.018f),
                          line(at(0.13f, 0), at(0.27f, -0.08f), at(0.13f, -0.17f), 0.018f),
                          line(at(0, 0), at(0, 0), at(0.13f, 0), 0.018f),
                          disc(at(0, 0), 0.075f, nose_colour)};
  if (whiskers != 0)
    for (const float side : {-1.f, 1.f})
      for (const float down : {-0.06f, 0.03f, 0.12f})
        marks.push_back(line(at(0.08f, 0.14f * side), at(0.08f + 0.5f * down, 0.3f * side),
                             at(0.06f + down, 0.44f * side), 0.01f, whiskers));
  return marks;
}

/// Teeth along a way.
std::vector<Mark> teeth(int from, int to, float side, float length, int count) {
  std::vector<Mark> marks;
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    marks.push_back(
        limb({from, to, t, side}, {from, to, t, side + length}, 0.042f, 0.004f, 0xffffff));
  }
  return marks;
}

/// The eyes on the feathers of a peacock.
std::vector<Mark> fan(int knuckle) {
  std::vector<Mark> marks;
  for (const float t : {0.42f, 0.9f}) {
    const Spot at(knuckle, knuckle + 3, t);
    marks.push_back(disc(at, 0.085f, 0xc8862a));
    marks.push_back(disc(at, 0.062f, 0x18b0a0));
    marks.push_back(disc(at, 0.036f, 0x141878));
  }
  return marks;
}
std::vector<Mark> suckers(int knuckle) {
  std::vector<Mark> marks;
  for (const float t : {0.1f, 0.35f, 0.6f, 0.82f, 1.f})
    marks.push_back(disc({knuckle, knuckle + 3, t}, 0.034f, 0xffd0dc));
  return marks;
}
std::vector<Mark> bands(int knuckle, std::uint32_t colour) {
  std::vector<Mark> marks;
  for (const float t : {0.2f, 0.5f, 0.8f})
    marks.push_back(line({knuckle, knuckle + 3, t, -0.08f}, {knuckle, knuckle + 3, t + 0.04f},
                         {knuckle, knuckle + 3, t, 0.08f}, 0.035f, colour));
  return marks;
}

Drawing dog() {
  return {0xd89850,
          0x8a5020,
          fur,
          {limb(T1, T3, 0.12f, 0.09f, 0x5a3010, fur),
           limb({M0, T1, 0.42f}, {M0, T1, 0.5f}, 0.2f, 0.19f, 0x6a3814, fur),
           limb({M1, R1, 0.3f}, {M3, R3, 0.3f}, 0.22f, 0.22f, 0xf8e4c0, fur),
           limb(L1, L3, 0.07f, 0.07f, 0xf8e4c0, fur),
           limb({L0, L1, 0.7f, 0.03f}, {L2, L3, 0.8f, 0.03f}, 0.035f, 0.045f, 0xf06078),
           limb({W, P, 0.15f, 0.4f}, {W, P, 0.15f, -0.4f}, 0.05f, 0.05f, 0xd02020),
           eye({M0, T1, 0.42f}, 0.11f, 0x5a3010), disc({M3, I3, 0.25f}, 0.11f, 0x181010),
           line({R3, R2, 0.f, -0.05f}, {R1, L0, 0.3f}, {R0, L0, 0.6f, 0.02f}, 0.024f)}};
}
Drawing horse() {
  return {0x9a5426,
          0x5c2c0e,
          fur,
          {limb(T1, T3, 0.1f, 0.05f, 0x7a4018, fur),
           limb({T1, T2, 0.3f, -0.1f}, {W, T1, 0.3f, -0.1f}, 0.14f, 0.16f, 0x141008, fur),
           limb({W, T1, 0.3f, -0.1f}, {W, T1, -0.6f, -0.05f}, 0.16f, 0.14f, 0x141008, fur),
           limb({T1, I0, 0.2f}, {M0, T1, 0.8f}, 0.1f, 0.05f, 0x141008, fur),
           limb({M2, R2, 0.2f}, {M3, R3, 0.2f}, 0.24f, 0.26f, 0x4a4444, fur),
           limb({I0, I1, 0.1f}, {I2, I3, 0.7f}, 0.055f, 0.05f, 0xffffff, fur),
           eye({M0, T1, 0.3f}, 0.1f, 0x3a1c08), disc({M3, M2, 0.25f}, 0.05f, 0x080404),
           line({L3, R3, 0.6f}, {L2, R2, 0.7f}, {L1, R1, 0.4f}, 0.024f)}};
}
Drawing fish() {
  return {0xff8a1c,
          0xd05000,
          scales,
          {limb({M0, M1, 0.7f}, {M3, R3, 0.5f}, 0.35f, 0.35f, 0xffc030, fur),
           limb({I0, L0, -0.3f}, {I0, L0, 1.3f}, 0.075f, 0.075f, 0xffffff),
           limb({W, I0, 0.42f, -0.12f}, {W, L0, 0.42f, 0.12f}, 0.06f, 0.06f, 0xffffff),
           limb({P, M0, 0.35f, 0.1f}, {P, M0, 0.9f, 0.16f}, 0.05f, 0.09f, 0xffc030, fur),
           eye({W, P, 0.4f, 0.1f}, 0.1f, 0x202020),
           line({W, P, -0.35f, -0.02f}, {W, P, 0.0f, -0.09f}, {W, P, 0.18f, -0.03f}, 0.024f)}};
}
Drawing wolf() {
  return {0xa8b0bc,
          0x4a5060,
          fur,
          {limb({P, W, 0.1f}, {W, P, -0.4f}, 0.17f, 0.25f, 0xf4f4f4, fur),
           limb({I0, P, 0.45f, -0.05f}, {M0, P, 0.2f}, 0.12f, 0.13f, 0xf4f4f4, fur),
           limb(I0, I3, 0.1f, 0.06f, 0x6a7080, fur), limb(L0, L3, 0.09f, 0.05f, 0x6a7080, fur),
           limb(I1, {I2, I3, 0.6f}, 0.04f, 0.02f, 0xe0a8a0),
           limb(L1, {L2, L3, 0.6f}, 0.035f, 0.02f, 0xe0a8a0),
           limb({M0, M1, 0.2f}, M3, 0.14f, 0.1f, 0xf0f0f0, fur),
           limb(T2, T3, 0.07f, 0.06f, 0xf0f0f0, fur), slit({I0, P, 0.25f}, 0.095f, 0xf0c020),
           disc({M3, M2, 0.1f}, 0.07f, 0x101014)}};
}
Drawing rabbit() {
  return {0xfff8f0, 0xc8b8a8, fur,
          together({limb({I0, I1, 0.5f}, {I2, I3, 0.8f}, 0.04f, 0.035f, 0xff98a8),
                    limb({M0, M1, 0.5f}, {M2, M3, 0.8f}, 0.04f, 0.035f, 0xff98a8),
                    limb({M0, W, 0.69f, 0.125f}, {M0, W, 0.78f, 0.125f}, 0.035f, 0.035f, 0xffffff),
                    limb({M0, W, 0.69f, 0.055f}, {M0, W, 0.78f, 0.055f}, 0.035f, 0.035f, 0xffffff),
                    disc({M0, W, 0.5f, 0.39f}, 0.07f, 0xffb8c0),
                    disc({M0, W, 0.5f, -0.21f}, 0.07f, 0xffb8c0),
                    eye({M0, W, 0.22f, 0.29f}, 0.12f, 0x40281c),
                    eye({M0, W, 0.22f, -0.11f}, 0.12f, 0x40281c)},
                   face(0.09f, 0.48f, 0xff7088, 0x807068))};
}
Drawing giraffe() {
  return {0xf8d890,
          0xa05a1c,
          patches,
          {limb({I2, M2, 0.5f}, {I3, M3, 0.5f}, 0.15f, 0.15f, 0xf0c070),
           limb({I3, M3, 0.1f}, {I3, I2, -0.05f}, 0.05f, 0.05f, 0x5a2c10),
           limb({M3, I3, 0.1f}, {M3, M2, -0.05f}, 0.05f, 0.05f, 0x5a2c10),
           eye({I2, I3, 0.25f}, 0.06f, 0x301808), eye({M2, M3, 0.25f}, 0.06f, 0x301808),
           limb({I1, M1, 0.5f}, {I2, M2, 0.5f}, 0.12f, 0.12f, 0xffe8c0),
           disc({I1, I2, 0.35f}, 0.025f, 0x402010), disc({M1, M2, 0.35f}, 0.025f, 0x402010),
           line({I1, I2, 0.05f, 0.05f}, {I1, M1, 0.5f, 0.1f}, {M1, M2, 0.05f, -0.05f}, 0.02f)}};
}
Drawing cat() {
  return {
      0xf0a040, 0xb05c14, stripes,
      together({limb({I0, I1, 0.2f}, I1, 0.07f, 0.03f, 0xffa8a0),
                limb({L0, L1, 0.2f}, L1, 0.06f, 0.03f, 0xffa8a0),
                limb({M0, W, 0.5f, 0.19f}, {M0, W, 0.55f, 0.19f}, 0.14f, 0.13f, 0xfff0d8, fur),
                limb({M0, W, 0.5f, -0.01f}, {M0, W, 0.55f, -0.01f}, 0.14f, 0.13f, 0xfff0d8, fur),
                slit({M0, W, 0.22f, 0.31f}, 0.13f, 0x70e030),
                slit({M0, W, 0.22f, -0.13f}, 0.13f, 0x70e030)},
               face(0.09f, 0.44f, 0xff7888, 0xffffff))};
}
Drawing bear() {
  return {0x9a6030, 0x4a2810, fur,
          together(
              {limb(I0, I0, 0.17f, 0.17f, 0x6a3c18, fur), limb(L0, L0, 0.17f, 0.17f, 0x6a3c18, fur),
               limb(I0, I0, 0.09f, 0.09f, 0xd8a070), limb(L0, L0, 0.09f, 0.09f, 0xd8a070),
               limb({M0, W, 0.6f, 0.09f}, {M0, W, 0.66f, 0.09f}, 0.25f, 0.25f, 0xdcb080, fur),
               eye({M0, W, 0.28f, 0.29f}, 0.08f, 0x180c04),
               eye({M0, W, 0.28f, -0.11f}, 0.08f, 0x180c04)},
              face(0.09f, 0.53f, 0x100804, 0))};
}
Drawing mouse() {
  return {
      0xb8b0b0,
      0x787078,
      fur,
      {limb(L0, L3, 0.09f, 0.05f, 0xf09890, wrinkles),
       limb({P, I0, 0.15f}, {P, I0, 0.15f}, 0.26f, 0.26f, 0x8c8488, fur),
       limb({P, I0, 0.15f}, {P, I0, 0.15f}, 0.18f, 0.18f, 0xffa8b0),
       eye({W, P, 0.45f, 0.02f}, 0.09f, 0x100808), disc({W, P, -0.3f}, 0.07f, 0xff7088),
       line({W, P, -0.05f, 0.05f}, {W, P, -0.1f, 0.2f}, {W, P, -0.2f, 0.3f}, 0.012f, 0x302830),
       line({W, P, 0.05f, 0.05f}, {W, P, 0.1f, 0.2f}, {W, P, 0.1f, 0.32f}, 0.012f, 0x302830),
       line({W, P, -0.05f, -0.05f}, {W, P, -0.1f, -0.2f}, {W, P, -0.2f, -0.3f}, 0.012f, 0x302830)}};
}
Drawing deer() {
  return {0xc88848, 0x8a5424, fur,
          together(
              {limb(I0, I3, 0.12f, 0.1f, 0xf0dcb0, wrinkles),
               limb(L0, L3, 0.1f, 0.09f, 0xf0dcb0, wrinkles),
               limb(T1, T3, 0.11f, 0.08f, 0x9a6030, fur), limb(T2, T3, 0.05f, 0.03f, 0xf0b8a0),
               limb({M0, W, 0.62f}, {M0, W, 0.85f}, 0.17f, 0.15f, 0xfff0d8, fur),
               eye({M0, W, 0.3f, 0.2f}, 0.1f, 0x301808), eye({M0, W, 0.3f, -0.2f}, 0.1f, 0x301808)},
              face(0, 0.62f, 0x181008, 0))};
}
Drawing bull() {
  return {
      0x6a3820,
      0x34180c,
      fur,
      {limb({T1, T2, 0.4f}, T3, 0.11f, 0.07f, 0xf4e8c8, wrinkles),
       limb({L0, L1, 0.3f}, L3, 0.1f, 0.06f, 0xf4e8c8, wrinkles),
       limb({T3, T2, 0.35f}, T3, 0.08f, 0.08f, 0x282018),
       limb({L3, L2, 0.4f}, L3, 0.08f, 0.08f, 0x282018),
       limb({M0, W, 0.72f, 0.06f}, {M0, W, 0.72f, -0.06f}, 0.23f, 0.23f, 0xe0a898),
       eye({M0, W, 0.28f, 0.2f}, 0.095f, 0x401008), eye({M0, W, 0.28f, -0.2f}, 0.095f, 0x401008),
       disc({M0, W, 0.66f, 0.11f}, 0.05f, 0x301410), disc({M0, W, 0.66f, -0.11f}, 0.05f, 0x301410),
       line({M0, W, 0.72f, 0.1f}, {M0, W, 1.08f}, {M0, W, 0.72f, -0.1f}, 0.035f, 0xf0c020),
       line({M0, W, 0.14f, 0.3f}, {M0, W, 0.1f, 0.2f}, {M0, W, 0.2f, 0.1f}, 0.025f),
       line({M0, W, 0.14f, -0.3f}, {M0, W, 0.1f, -0.2f}, {M0, W, 0.2f, -0.1f}, 0.025f)}};
}
Drawing turtle() {
  return {0x9a8040,
          0x4a3814,
          plates,
          {limb(T1, T3, 0.16f, 0.13f, 0x80c050, scales),
           limb({W, P, -0.1f}, {W, P, -0.6f}, 0.3f, 0.3f, 0x80c050, scales),
           eye({T2, T3, 0.3f, -0.03f}, 0.06f, 0x201808),
           line({T3, T2, -0.1f, 0.09f}, {T3, T2, 0.05f, 0.03f}, {T3, T2, 0.25f, 0.07f}, 0.018f)}};
}
Drawing rooster() {
  return {0xfff0d0,
          0xd8a050,
          feathers,
          {limb(M0, M3, 0.13f, 0.11f, 0xe02020, bumps), limb(R0, R3, 0.12f, 0.1f, 0xe02020, bumps),
           limb(L0, L3, 0.11f, 0.09f, 0xe02020, bumps),
           limb({I1, T2, 0.3f}, {I3, T3, 0.5f}, 0.16f, 0.12f, 0xffb818),
           limb({T1, W, 0.0f}, {T1, W, 0.35f}, 0.09f, 0.11f, 0xe02020, bumps),
           limb({I0, P, 0.35f}, {I0, P, 0.35f}, 0.2f, 0.2f, 0xf04838),
           eye({I0, P, 0.3f}, 0.125f, 0xf08000),
           line({I1, T2, 0.5f}, {I2, T2, 0.5f}, {I3, T3, 0.5f}, 0.018f)}};
}
Drawing peacock() {
  auto marks = together(together(together(fan(I0), fan(M0)), fan(R0)), fan(L0));
  marks = together({limb(T1, T3, 0.13f, 0.11f, 0x1858d8, feathers),
                    limb({T1, P, 0.1f}, {P, W, 0.5f}, 0.17f, 0.3f, 0x1858d8, feathers),
                    limb({T3, T2, 0.35f}, {T3, T2, -0.1f}, 0.1f, 0.05f, 0xffc828)},
                   marks);
  return {0x20a858, 0x0c5838, feathers,
          together(marks, {eye({T2, T3, 0.1f, -0.03f}, 0.06f, 0x101010)})};
}
Drawing octopus() {
  auto marks = together(together(together(suckers(I0), suckers(M0)), suckers(R0)), suckers(L0));
  return {0xc060d0, 0x783098, bumps,
          together(marks, {eye({P, W, 0.25f, 0.19f}, 0.16f, 0x301848),
                           eye({P, W, 0.25f, -0.19f}, 0.16f, 0x301848),
                           line({P, M0, 0.4f, 0.14f}, {P, M0, 0.9f}, {P, M0, 0.4f, -0.14f}, 0.028f),
                           disc({T1, T2, 0.3f}, 0.034f, 0xffd0dc),
                           disc({T1, T3, 0.95f}, 0.034f, 0xffd0dc), disc(T2, 0.034f, 0xffd0dc)})};
}
Drawing elephant() {
  return {
      0xa8acb8,
      0x747884,
      wrinkles,
      {limb({M0, W, 0.4f, 0.46f}, {M0, W, 0.55f, 0.42f}, 0.22f, 0.2f, 0x80848f, wrinkles),
       limb({M0, W, 0.4f, -0.46f}, {M0, W, 0.55f, -0.42f}, 0.22f, 0.2f, 0x80848f, wrinkles),
       limb({M0, W, 0.42f, 0.44f}, {M0, W, 0.52f, 0.42f}, 0.13f, 0.12f, 0xe0a8b0, wrinkles),
       limb({M0, W, 0.42f, -0.44f}, {M0, W, 0.52f, -0.42f}, 0.13f, 0.12f, 0xe0a8b0, wrinkles),
       limb(T1, T3, 0.13f, 0.11f, 0x8c909c, wrinkles),
       limb(L0, L3, 0.12f, 0.1f, 0x8c909c, wrinkles), limb(T1, T2, 0.07f, 0.05f, 0xe0a8b0),
       limb(L1, L2, 0.05f, 0.04f, 0xe0a8b0),
       limb({I0, I1, 0.1f}, {I0, I1, 1.3f}, 0.07f, 0.03f, 0xfff8e0),
       limb({R0, R1, 0.1f}, {R0, R1, 1.3f}, 0.07f, 0.03f, 0xfff8e0),
       eye({M0, W, 0.35f, 0.22f}, 0.09f, 0x301c10), eye({M0, W, 0.35f, -0.22f}, 0.09f, 0x301c10),
       line({M0, M3, 0.15f, -0.08f}, {M0, M3, 0.2f}, {M0, M3, 0.15f, 0.08f}, 0.016f, 0x505460),
       line({M0, M3, 0.35f, -0.08f}, {M0, M3, 0.4f}, {M0, M3, 0.35f, 0.08f}, 0.016f, 0x505460),
       line({M0, M3, 0.55f, -0.08f}, {M0, M3, 0.6f}, {M0, M3, 0.55f, 0.08f}, 0.016f, 0x505460),
       line({M0, M3, 0.75f, -0.08f}, {M0, M3, 0.8f}, {M0, M3, 0.75f, 0.08f}, 0.016f, 0x505460),
       disc({M3, M2, 0.1f}, 0.035f, 0x302830)}};
}
Drawing crocodile() {
  auto marks =
      together({limb(T1, T3, 0.13f, 0.1f, 0xb8c060, scales)}, teeth(I0, I3, 0.03f, 0.12f, 6));
  marks = together(marks, teeth(T1, T3, -0.04f, -0.11f, 4));
  return {0x6aa038, 0x2c5418, plates,
          together(marks, {slit({I0, P, 0.05f, 0.08f}, 0.085f, 0xf0d020),
                           disc({I3, I2, 0.15f, 0.03f}, 0.03f, 0x101808)})};
}
Drawing duck() {
  return {
      0xb0a898,
      0x6c6050,
      feathers,
      {limb({P, I0, 0.6f}, I0, 0.4f, 0.3f, 0x107848, feathers),
       limb({P, W, 0.25f, -0.4f}, {P, W, 0.25f, 0.4f}, 0.06f, 0.06f, 0xffffff),
       limb({I1, I0, 0.45f}, I3, 0.2f, 0.3f, 0xffb010), eye({I0, P, 0.2f, 0.02f}, 0.105f, 0x301808),
       disc({I1, I2, 0.3f, -0.05f}, 0.025f, 0x603808)}};
}
Drawing swan() {
  return {0xffffff,
          0xb0b8c8,
          feathers,
          {limb(I1, I3, 0.2f, 0.25f, 0xff8418),
           limb({I1, I0, 0.3f}, {I1, I2, 0.05f}, 0.09f, 0.06f, 0x141418),
           eye({I0, P, 0.15f}, 0.09f, 0x201818), disc({I2, I1, 0.4f, 0.04f}, 0.02f, 0x401808)}};
}
Drawing cobra() {
  return {
      0xa89838,
      0x504010,
      scales,
      {limb({W, P, 0.f, 0.1f}, {I0, P, 0.f, 0.12f}, 0.1f, 0.1f, 0xf0e0a0, stripes),
       limb(I1, I3, 0.16f, 0.13f, 0x8a7c28, scales), slit({I2, I1, 0.55f, -0.01f}, 0.08f, 0xf04010),
       line({I3, I2, 0.1f, 0.02f}, {I2, I3, 0.8f, 0.1f}, {I2, I1, 0.2f, 0.1f}, 0.02f),
       disc({I3, I2, 0.15f}, 0.02f, 0x101008)}};
}
Drawing eagle() {
  return {0x7a4c20, 0x3a2008, feathers,
          together(on_both({limb(I1, I3, 0.08f, 0.07f, 0x2c1806, feathers),
                            limb(M1, M3, 0.08f, 0.07f, 0x2c1806, feathers),
                            limb(R1, R3, 0.08f, 0.07f, 0x2c1806, feathers),
                            limb(L1, L3, 0.08f, 0.06f, 0x2c1806, feathers),
                            limb(T1, T3, 0.1f, 0.1f, 0xffffff, feathers),
                            limb({T3, T2, 0.05f}, {T3, T2, -0.45f}, 0.05f, 0.01f, 0xffc018)}),
                   on_both({eye({T2, T3, 0.1f}, 0.05f, 0xf0b010)}))};
}
Drawing butterfly() {
  std::vector<Mark> tips;
  for (const int tip : {I3, M3, R3, L3}) {
    tips.push_back(limb({tip, tip - 1, 0.8f}, tip, 0.07f, 0.07f, 0x181010));
    tips.push_back(disc({tip, tip - 1, 0.15f}, 0.024f, 0xffffff));
    tips.push_back(disc({tip, tip - 1, 0.75f}, 0.018f, 0xffffff));
  }
  tips =
      together(tips, {limb(T1, T3, 0.09f, 0.08f, 0x181010), disc({P, M0, 0.5f}, 0.09f, 0x3080ff),
                      disc({P, M0, 0.5f}, 0.045f, 0x101050), eye({T3, T2, 0.4f}, 0.04f, 0xffc020)});
  return {0xff9020, 0x181010, plates, on_both(tips)};
}
Drawing spider() {
  auto legs =
      together(together(together(bands(I0, 0xd87820), bands(M0, 0xd87820)), bands(R0, 0xd87820)),
               bands(L0, 0xd87820));
  auto marks = on_both(together({limb(T2, T3, 0.05f, 0.04f, 0x804020, fur),
                                 limb({P, M0, 0.f}, {P, M0, 0.f}, 0.22f, 0.22f, 0x402a1c, fur)},
                                legs));
  return {0x604838, 0x201410, fur,
          together(marks, {eye({P, right(P), 0.2f, -0.2f}, 0.08f, 0xd02010),
                           eye({P, right(P), 0.8f, -0.2f}, 0.08f, 0xd02010),
                           eye({P, right(P), -0.2f, -0.14f}, 0.05f, 0xd02010),
                           eye({P, right(P), 1.2f, -0.14f}, 0.05f, 0xd02010),
                           limb({L0, right(L0), 0.5f, -0.2f}, {L0, right(L0), 0.5f, -0.12f}, 0.06f,
                                0.01f, 0xf02818),
                           limb({L0, right(L0), 0.5f, -0.04f}, {L0, right(L0), 0.5f, -0.12f}, 0.06f,
                                0.01f, 0xf02818)})};
}
Drawing owl() {
  const auto half = on_both({limb(M0, M3, 0.09f, 0.06f, 0x6a4420, feathers),
                             limb(R0, R3, 0.09f, 0.06f, 0x6a4420, feathers),
                             limb(L0, L3, 0.08f, 0.05f, 0x6a4420, feathers),
                             limb({P, M0, 0.55f}, {P, M0, 0.55f}, 0.26f, 0.26f, 0xe8d0a0, feathers),
                             eye({P, M0, 0.55f, 0.02f}, 0.17f, 0xffb010)});
  return {0xb88850, 0x644018, feathers,
          together(half, {limb({P, right(P), 0.5f, 0.0f}, {P, right(P), 0.5f, 0.3f}, 0.13f, 0.01f,
                               0xffa818)})};
}
Drawing crab() {
  return {0xf05028, 0xb02810, bumps,
          on_both({limb({I1, I2, 0.5f}, I3, 0.07f, 0.06f, 0xffd8b0),
                   limb({M1, M2, 0.5f}, M3, 0.07f, 0.06f, 0xffd8b0),
                   limb({R1, R2, 0.5f}, R3, 0.07f, 0.06f, 0xffd8b0),
                   limb({L1, L2, 0.5f}, L3, 0.07f, 0.05f, 0xffd8b0),
                   eye({T3, T2, 0.45f}, 0.055f, 0x101010),
                   line({W, P, 0.1f, 0.02f}, {W, P, 0.3f, -0.1f}, {W, P, 0.8f, -0.04f}, 0.025f),
                   disc({P, M0, 0.3f, 0.05f}, 0.03f, 0xffb090),
                   disc({P, M0, 0.6f, -0.04f}, 0.025f, 0xffb090)})};
}
Drawing snail() {
  return {
      0xe8c890,
      0xb08850,
      wrinkles,
      {limb({M0, W, 0.4f}, {M0, W, 0.5f}, 0.5f, 0.45f, 0xc07030, stripes),
       spiral({M0, W, 0.45f}, 0.36f, 0x5a2808), eye({right(I3), right(I2), 0.3f}, 0.055f, 0x181008),
       eye({right(M3), right(M2), 0.3f}, 0.055f, 0x181008)}};
}

}  // namespace

std::span<const Drawing> drawings() {
  static const std::vector<Drawing> kAll{
      dog(),       horse(),    fish(),      wolf(), rabbit(), giraffe(), cat(),
      bear(),      mouse(),    deer(),      bull(), turtle(), rooster(), peacock(),
      octopus(),   elephant(), crocodile(), duck(), swan(),   cobra(),   eagle(),
      butterfly(), spider(),   owl(),       crab(), snail()};
  return kAll;
}

}  // namespace handcast::projegraphy
