// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/reflector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace handcast::calib {
namespace {

/// An image of a dark scene with a lit hand, and discs on it.
class Scene {
 public:
  explicit Scene(int hand_grey) : picture_{320, 240, std::vector<std::uint8_t>(320 * 240, 9)} {
    for (int y = 60; y < 240; ++y)
      for (int x = 120; x < 180; ++x) at(x, y) = static_cast<std::uint8_t>(hand_grey);
  }

  /// A disc whose edge pixels are covered in part.
  Scene& disc(const glm::dvec2& centre, double radius_px, double grey = 255) {
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x) {
        const double inside = radius_px + 0.5 - glm::distance(centre, glm::dvec2(x, y));
        const double share = std::clamp(inside, 0., 1.);
        at(x, y) = static_cast<std::uint8_t>(std::lround(share * grey + (1 - share) * at(x, y)));
      }
    return *this;
  }
  Scene& noise(double sd, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, sd);
    for (auto& pixel : picture_.pixels)
      pixel = static_cast<std::uint8_t>(std::clamp(std::lround(pixel + normal(random)), 0L, 255L));
    return *this;
  }
  Reflector find() const { return find_reflector(picture_.view()); }

 private:
  std::uint8_t& at(int x, int y) { return picture_.pixels[static_cast<std::size_t>(320 * y + x)]; }
  GreyPicture picture_;
};

TEST(Reflector, IsFoundToAFractionOfAPixelOnTheEdgeOfAHand) {
  for (int i = 0; i < 20; ++i) {
    const glm::dvec2 centre(150 + 0.13 * i, 60 + 0.29 * i);
    const auto found = Scene(120).disc(centre, 3 + 0.2 * i).noise(2, 7).find();
    ASSERT_EQ(found.fault, ReflectorFault::none) << i;
    EXPECT_LT(glm::distance(found.image_px, centre), 0.15) << i;
    EXPECT_NEAR(found.diameter_px, 2 * (3 + 0.2 * i), 1.5) << i;
  }
}

TEST(Reflector, SeveralAreNotOne) {
  EXPECT_EQ(Scene(120).disc({150, 60}, 5).disc({40, 40}, 4).find().fault, ReflectorFault::several);
}

TEST(Reflector, AHandAsBrightAsTheReflectorIsSaid) {
  EXPECT_EQ(Scene(250).disc({150, 60}, 5).find().fault, ReflectorFault::merged);
  EXPECT_EQ(Scene(220).disc({250, 100}, 5).find().fault, ReflectorFault::merged) << "beside it";
}

TEST(Reflector, ADarkImageHasNoneAndNoiseIsNone) {
  EXPECT_EQ(Scene(9).noise(3, 1).find().fault, ReflectorFault::dark);
  EXPECT_EQ(Scene(60).find().fault, ReflectorFault::dark);
  EXPECT_EQ(Scene(9).disc({40, 40}, 0.6).find().fault, ReflectorFault::dark) << "a hot pixel";
  EXPECT_EQ(find_reflector({}).fault, ReflectorFault::dark);
}

TEST(Reflector, AStripIsNoReflector) {
  Scene scene(60);
  for (int i = 0; i < 20; ++i) scene.disc({200 + i, 100}, 2);
  EXPECT_EQ(scene.find().fault, ReflectorFault::merged);
}

TEST(Reflector, EachFaultHasAdvice) {
  EXPECT_EQ(advice_on(ReflectorFault::none), "");
  for (const auto fault : {ReflectorFault::dark, ReflectorFault::several, ReflectorFault::merged})
    EXPECT_GT(advice_on(fault).size(), 20U);
}

}  // namespace
}  // namespace handcast::calib
