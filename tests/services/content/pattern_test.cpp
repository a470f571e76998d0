// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "renderer/media/picture.hpp"
#include "services/content/source.hpp"

using namespace handcast;
using namespace handcast::content;
using testing::HasSubstr;

namespace {

class PatternTest : public testing::Test {
 protected:
  Opening opening(std::string name, std::string parameter = {}, std::string value = {}) {
    Opening opening;
    opening.element = {"pattern", std::move(name), {}};
    if (!parameter.empty()) opening.element.parameters = {{parameter, value}};
    opening.meshes = {&hand_, nullptr};
    return opening;
  }
  renderer::Texture drawn(const Opening& opening) {
    renderer::Texture out(opening.width, opening.height);
    const auto source = open_source(opening);
    EXPECT_TRUE(source) << source.error().what;
    if (!source) return out;
    EXPECT_EQ((*source)->draw({}, {}, out), true);
    EXPECT_EQ((*source)->draw({}, {}, out), false);
    if (const char* folder = std::getenv("SHOW"))
      (void)renderer::write_png(std::string(folder) + "/" + opening.element.what + ".png",
                                std::as_const(out).view());
    return out;
  }
  static std::size_t colours(const renderer::Texture& picture) {
    return std::set(picture.pixels().begin(), picture.pixels().end()).size();
  }

  renderer::HandMesh hand_ = *renderer::load_hand_or_default({}, Side::left);
};

TEST_F(PatternTest, EveryPatternIsOpaqueAndNotOfOneColour) {
  for (const auto* name : {"atlas", "checker", "skeleton", "seams", "joints", "bones"}) {
    const auto picture = drawn(opening(name));
    EXPECT_GT(colours(picture), 3u) << name;
    for (const auto pixel : picture.pixels()) ASSERT_EQ(pixel >> 24, 255u) << name;
  }
}

TEST_F(PatternTest, WhiteNeedsNoHand) {
  Opening white;
  white.element = {"pattern", "white", {}};
  EXPECT_EQ(drawn(white).at(7, 7), 0xffffffffu);
  white.element.what = "atlas";
  EXPECT_THAT(open_source(white).error().what, HasSubstr("there is none here"));
}

TEST_F(PatternTest, AnUnknownNameIsAnsweredWithAllNames) {
  EXPECT_THAT(open_source(opening("plaid")).error().what, HasSubstr("skeleton"));
}

TEST_F(PatternTest, BonesShowTheSkinWeightsOfOneJoint) {
  const auto all = drawn(opening("bones"));
  const auto one = drawn(opening("bones", "joint", "index-finger-phalanx-proximal"));
  EXPECT_GT(colours(one), 20u);
  EXPECT_NE(all.pixels(), one.pixels());
  const auto same = drawn(opening("bones", "joint", "7"));
  EXPECT_EQ(one.pixels(), same.pixels());
  EXPECT_THAT(open_source(opening("bones", "joint", "elbow")).error().what, HasSubstr("thumb-tip"));
}

TEST_F(PatternTest, BarsShowAValuePerJoint) {
  const auto none = drawn(opening("bars"));
  const auto wrist = drawn(opening("bars", "value1", "1"));
  EXPECT_EQ(colours(none), 2u);  // and black far from the hand
  EXPECT_EQ(colours(wrist), 3u);
  EXPECT_EQ(wrist.pixels(), drawn(opening("bars", "values", "0,1,0")).pixels());
  EXPECT_THAT(open_source(opening("bars", "values", "0,2")).error().what, HasSubstr("value1"));
  EXPECT_THAT(open_source(opening("bars", "values", std::string(40, ','))).error().what,
              HasSubstr("too many"));
}

}  // namespace
