// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/hand_mesh.hpp"
#include "services/content/surface_map.hpp"
#include "tests/services/content/shader/shader_test.hpp"

namespace handcast::test {
namespace {

class HandsInShaders : public ShaderTest {
 protected:
  void SetUp() override {
    ShaderTest::SetUp();
    opening_.width = 128;
    opening_.height = 80;
    opening_.meshes = {&left_, &right_};
    opening_.side = Side::left;
  }
  /// A picture whose colour is a vec3 that a shader computes.
  std::uint32_t shown(const std::string& value) {
    return colour(isf("", "void main() { gl_FragColor = vec4(vec3(" + value + "), 1.0); }"));
  }

  renderer::HandMesh left_ = *renderer::load_hand_or_default({}, Side::left),
                     right_ = *renderer::load_hand_or_default({}, Side::right);
};

TEST_F(HandsInShaders, TheStatesOfBothHands) {
  hand_.is_there = true;
  hand_.joints_m[10] = {0.2f, 0.4f, 0.6f};
  hand_.pinch = 0.2f;
  hand_.spread = 0.4f;
  hand_.curl = 0.6f;
  hand_.velocity_m_s = {0, 0.6f, 0.8f};
  hand_.palm_normal = {0, 1, 0};
  hand_.gravity = {1, 0, 0};
  other_.pinch = 0.8f;
  EXPECT_EQ(shown("hand_there, other_there, 0"), kRed);
  EXPECT_EQ(shown("hand_side, other_side, 0"), kGreen);
  EXPECT_EQ(shown("hand_joint[10]"), 0xff996633u);
  EXPECT_EQ(shown("hand_pinch, hand_spread, hand_curl"), 0xff996633u);
  EXPECT_EQ(shown("hand_speed, hand_normal.y, hand_gravity.x"), kWhite);
  EXPECT_EQ(shown("other_pinch, 0, 0"), kBlack | 204u);
}

TEST_F(HandsInShaders, WhatFollowsTheHandIsDrawnAgain) {
  const auto still = isf("", "void main() { gl_FragColor = vec4(hand_palm_uv[10], 0, 1); }");
  draw(*still);
  draw(*still);
  EXPECT_FALSE(is_new_) << "places at rest do not move";
  const auto live = isf("", "void main() { gl_FragColor = vec4(hand_pinch, 0, 0, 1); }");
  draw(*live);
  hand_.pinch = 1;
  EXPECT_EQ(colour(live), kRed);
}

TEST_F(HandsInShaders, MapsTellBackAndPalm) {
  const auto source =
      isf("",
          "void main() { vec4 at = texture(hand_rest, isf_FragNormCoord); gl_FragColor "
          "= vec4(at.w > 0.5, at.w < -0.5, 0, 1); }");
  const auto& drawn = draw(*source);
  std::map<std::uint32_t, int> count;
  for (const auto texel : drawn.pixels()) ++count[texel];
  EXPECT_GT(count[kRed], 1000) << "the back";
  EXPECT_GT(count[kGreen], 1000) << "the palm";
  EXPECT_LE(count.size(), 3u);
}

TEST_F(HandsInShaders, JointsLieOnTheMap) {
  // The map at the place of a fingertip is near the fingertip.
  const auto source = isf("", R"(void main() {
    float most = 0.0;
    for (int i = 1; i < 26; ++i) {
      vec3 away = texture(hand_rest, hand_palm_uv[i]).xyz - hand_rest_joint[i];
      most = max(most, length(away.xz));
    }
    gl_FragColor = vec4(most / 255.0, 0, 0, 1); })");
  EXPECT_LT(level(colour(source), 0), 8) << "mm";
}

TEST_F(HandsInShaders, TheBoneOfATexelIsThatOfItsLargestWeight) {
  const auto source = isf("", R"(void main() {
    gl_FragColor = vec4(texture(hand_bone, isf_FragNormCoord).x / 255.0, 0, 0, 1); })");
  const auto drawn = draw(*source);
  int wrong = 0, all = 0;
  for (const auto& texel : surface_map_of(left_, drawn.width(), drawn.height())->texels()) {
    std::map<int, float> weights;
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t k = 0; k < 4; ++k)
        weights[left_.joints[texel.corners[corner]][k]] +=
            texel.parts[corner] * left_.weights[texel.corners[corner]][k];
    const auto weight = [](const auto& each) { return each.second; };
    const int joint = std::ranges::max_element(weights, {}, weight)->first;
    const int told = level(drawn.pixels()[texel.index], 0);
    // Two joints may be equally strong.
    wrong += std::abs(weights[joint] - weights[told]) > 1e-4f;
    ++all;
  }
  EXPECT_GT(all, 1000);
  EXPECT_EQ(wrong, 0);
}

TEST_F(HandsInShaders, MapsOfTheMomentNeedTheSurface) {
  const auto source = isf("",
                          "void main() { gl_FragColor = vec4(texture(hand_position, "
                          "isf_FragNormCoord).z, abs(texture(hand_surface_normal, "
                          "isf_FragNormCoord).x), 0, 1); }");
  EXPECT_TRUE(source->needs().surface);
  EXPECT_EQ(colour(source), kBlack) << "a hand that is not there";
  const std::vector<glm::vec3> positions(left_.vertex_count(), {0, 0, 0.6f}),
      normals(left_.vertex_count(), {1, 0, 0});
  hand_.positions_m = positions;
  hand_.normals = normals;
  const auto& drawn = draw(*source);
  EXPECT_EQ(std::ranges::count(drawn.pixels(), kBlack),
            std::ranges::count_if(drawn.pixels(),
                                  [](auto p) { return p != (kBlack | 153u | 255u << 8); }));
  EXPECT_GT(std::ranges::count(drawn.pixels(), kBlack | 153u | 255u << 8), 2000);
}

TEST_F(HandsInShaders, WithoutAHandEverythingIsZero) {
  opening_.meshes = {};
  EXPECT_EQ(shown("texture(hand_rest, isf_FragNormCoord).w, hand_palm_uv[3]"), kBlack);
}

TEST_F(HandsInShaders, AShadertoyProgramHasThemToo) {
  hand_.pinch = 1;
  EXPECT_EQ(colour(toy("void mainImage(out vec4 c, in vec2 p) { c = vec4(hand_pinch, 0, 0, 1); }")),
            kRed);
}

}  // namespace
}  // namespace handcast::test
