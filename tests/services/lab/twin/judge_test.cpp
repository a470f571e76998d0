// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "services/lab/twin/surface.hpp"
#include "tests/services/lab/twin/world.hpp"

namespace handcast::twin {
namespace {

constexpr int kWidth = 1024, kHeight = 768;
constexpr std::int64_t kLit_ns = 1'230'000'000;

double mean_of(const std::vector<float>& values) {
  return values.empty() ? -1
                        : std::accumulate(values.begin(), values.end(), 0.0) /
                              static_cast<double>(values.size());
}

/// A projection whose region is the whole projector, dark at first.
class Projected {
 public:
  Projected() : bytes_((msg::Projection::bytes(kWidth, kHeight) + 7) / 8) {
    auto& p = *new (bytes_.data()) msg::Projection;
    p.width_px = p.region_width_px = kWidth;
    p.height_px = p.region_height_px = kHeight;
    p.lit_ns = kLit_ns;
  }
  msg::Projection& operator*() { return *reinterpret_cast<msg::Projection*>(bytes_.data()); }
  msg::Projection* operator->() { return &**this; }
  void light(int x, int y) { (*this)->pixels()[y * kWidth + x] = 0xff8040ff; }

 private:
  std::vector<std::uint64_t> bytes_;
};

/// Light drawn from the truth: for the hands as they are at `time_ns`, displaced by `shift_px`. The
/// hand's flesh is the drawn mesh.
class PerfectLight {
 public:
  PerfectLight(const Twin& twin, std::int64_t time_ns, glm::vec2 shift_px = {0, 0})
      : twin_(twin), shift_px_(shift_px), depth_(kWidth, kHeight) {
    light_->has_shown = 1;
    for (const Side side : {Side::left, Side::right})
      if (const auto joints = twin.joints(side, time_ns)) draw(side, *joints);
  }
  Projected& operator*() { return light_; }

 private:
  void draw(Side side, const JointFrames& joints) {
    const auto rig = calib::reference_rig();
    const auto& mesh = twin_.true_hand(side).mesh;
    std::vector<glm::vec3> positions(mesh.vertex_count());
    pose(twin_.true_hand(side), joints, positions);
    light_->hands[light_->hand_count++].side = side;
    ScreenVertices screen;
    screen.resize(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const glm::dvec3 p(rig.camera_from_tracker * glm::dvec4(positions[v], 1));
      const glm::vec2 px = glm::vec2(rig.projector.pixel_of(rig.camera.project(p))) + shift_px_;
      screen.x[v] = px.x;
      screen.y[v] = px.y;
      screen.inverse_depth[v] = static_cast<float>(1 / p.z);
    }
    for (const auto& t : mesh.triangles)
      draw_triangle(screen, t, -1, {0, 0, kWidth, kHeight}, depth_.view(),
                    [&](int x, int y, float, float, float) { put(mesh, screen, t, x, y); });
  }

  void put(const renderer::HandMesh& mesh, const ScreenVertices& screen,
           const std::array<std::uint16_t, 3>& t, int x, int y) {
    const auto behind = [&](int k) {
      return glm::vec3(glm::inverse(mesh.rest[1]) * glm::vec4(mesh.positions[t[k]], 1)).z;
    };
    const glm::vec3 share = barycentrics(screen, t, static_cast<float>(x), static_cast<float>(y));
    if (share.x * behind(0) + share.y * behind(1) + share.z * behind(2) > 0.005f) return;
    light_.light(x, y);
    if (x % msg::Projection::kShownStep_px || y % msg::Projection::kShownStep_px) return;
    const glm::vec2 uv =
        share.x * mesh.uv[t[0]] + share.y * mesh.uv[t[1]] + share.z * mesh.uv[t[2]];
    light_->shown(x, y) = {static_cast<std::uint16_t>(std::lround(65535 * uv.x)),
                           static_cast<std::uint16_t>(std::lround(65535 * uv.y)),
                           static_cast<std::uint8_t>(light_->hand_count), 0};
  }

  const Twin& twin_;
  glm::vec2 shift_px_;
  renderer::Image<float> depth_;
  Projected light_;
};

Projected light_of(const Twin& twin, std::int64_t time_ns, glm::vec2 shift_px = {0, 0}) {
  return *PerfectLight(twin, time_ns, shift_px);
}

class JudgeOf : public testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Twin> twin_ = twin_of(rig_with(GetParam()));
  std::unique_ptr<Judge> judge_ = Judge::create(*twin_, 4);
};

TEST_P(JudgeOf, PerfectLightHasNoError) {
  auto light = light_of(*twin_, kLit_ns);
  const auto score = judge_->score(*light);
  EXPECT_EQ(score.display_ns, kLit_ns);
  ASSERT_FALSE(score.hands.empty());
  for (const auto& hand : score.hands) {
    EXPECT_GT(hand.hand_px, 10'000);
    EXPECT_NEAR(static_cast<double>(hand.interior_px.size()), hand.hand_px / 16.0,
                0.05 * hand.hand_px / 16.0);
    EXPECT_LT(*std::max_element(hand.interior_px.begin(), hand.interior_px.end()), 0.1)
        << "texture coordinates have 16 bits";
    EXPECT_TRUE(hand.missing_px.empty());
    EXPECT_GT(static_cast<double>(hand.lit_px) / hand.hand_px, 0.999);
    EXPECT_LT(hand.spill_px, 20);
    EXPECT_LT(hand.seam_px, 20);
    EXPECT_NEAR(static_cast<double>(hand.union_px), hand.hand_px, 20);
  }
}

TEST_P(JudgeOf, LightBesideItsPlaceIsThatFarOff) {
  auto light = light_of(*twin_, kLit_ns, {3, 4});
  const double mm_per_px = calib::reference_rig().mm_per_projector_px(0.73);
  const auto score = judge_->score(*light);
  ASSERT_FALSE(score.hands.empty());
  for (const auto& hand : score.hands) {
    EXPECT_NEAR(mean_of(hand.interior_px), 5, 0.1);
    EXPECT_GT(mean_of(hand.interior_mm), 5 * mm_per_px * 0.95) << "the hand is about 0.73 m away";
    EXPECT_LT(mean_of(hand.interior_mm), 5 * mm_per_px * 1.6) << "its surface is slanted";
    EXPECT_GT(hand.spill_px, 500);
    EXPECT_LT(hand.lit_px, hand.hand_px - 500);
    EXPECT_EQ(hand.union_px, hand.hand_px + hand.spill_px);
    EXPECT_GT(hand.seam_px, 100);
  }
}

TEST_P(JudgeOf, LateLightHasItsAgeAsEquivalentLatency) {
  double lag = 0, speed2 = 0;
  for (std::int64_t i = 0; i < 12; ++i) {
    const std::int64_t display_ns = kLit_ns + i * 137'000'000;
    auto light = light_of(*twin_, display_ns - 10'000'000);
    light->lit_ns = display_ns;
    for (const auto& hand : judge_->score(*light).hands) {
      lag += hand.lag_px_s;
      speed2 += hand.speed2_px_s2;
    }
  }
  EXPECT_NEAR(1e3 * lag / speed2, 10, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Motions, JudgeOf,
                         testing::Values("builtin:wave", "builtin:open_close", "builtin:two_hands"),
                         [](const auto& motion) { return std::string(motion.param).substr(8); });

TEST(Judge, SpeedIsThatOfTheSurface) {
  const auto twin = twin_of(rig_with("builtin:shake"));
  const auto judge = Judge::create(*twin, 4);
  double fastest = 0;
  for (std::int64_t i = 0; i < 80; ++i) {
    const std::int64_t time_ns = 1'800'000'000 + i * 5'000'000;
    Projected dark;
    dark->lit_ns = time_ns;
    const auto score = judge->score(*dark);
    const auto before = *twin->joints(Side::left, time_ns - 1'000'000),
               after = *twin->joints(Side::left, time_ns + 1'000'000);
    const double palm = glm::distance(place(before[0]), place(after[0])) / 2e-3;
    EXPECT_NEAR(score.hands[0].speed_m_s, palm, 0.15 + 0.25 * palm);
    fastest = std::max(fastest, score.hands[0].speed_m_s);
  }
  EXPECT_GT(fastest, 1.0);
}

TEST(Judge, DarknessCoversNothingAndAllOfItIsMissing) {
  const auto twin = twin_of(rig_with("builtin:two_hands"));
  Projected dark;
  const auto score = Judge::create(*twin, 4)->score(*dark);
  ASSERT_EQ(score.hands.size(), 2u);
  for (const auto& hand : score.hands) {
    EXPECT_TRUE(hand.interior_px.empty());
    EXPECT_NEAR(static_cast<double>(hand.missing_px.size()), hand.hand_px / 16.0,
                0.05 * hand.hand_px / 16.0);
    EXPECT_GT(hand.hand_px, 10'000);
    EXPECT_EQ(hand.lit_px, 0);
    EXPECT_EQ(hand.spill_px, 0);
    EXPECT_EQ(hand.seam_px, 0);
  }
}

TEST(Judge, EachHandAnswersForItself) {
  const auto twin = twin_of(rig_with("builtin:two_hands"));
  auto light = light_of(*twin, kLit_ns);
  const auto right = twin->landmarks(Side::right, kLit_ns);
  const auto tip = calib::reference_rig().projector.pixel_of((*right)[12]);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x)
      light.light(static_cast<int>(tip.x) + x, static_cast<int>(tip.y) - 60 + y);
  light->hands[1].presence = 0.4f;
  const auto score = Judge::create(*twin, 4)->score(*light);
  ASSERT_EQ(score.hands.size(), 2u);
  EXPECT_GT(score.hands[0].interior_px.size(), 500u);
  EXPECT_LT(mean_of(score.hands[0].interior_px), 0.05);
  EXPECT_LT(score.hands[0].spill_px, 20);
  EXPECT_GE(score.hands[1].spill_px, 100);
  EXPECT_TRUE(score.hands[1].interior_px.empty()) << "less than half of the intended light";
  EXPECT_EQ(score.hands[1].lit_px, 0);
}

TEST(Judge, LightOfTheOtherHandIsMissingLight) {
  const auto twin = twin_of(rig_with("builtin:two_hands"));
  auto light = light_of(*twin, kLit_ns);
  std::swap(light->hands[0].side, light->hands[1].side);
  const auto score = Judge::create(*twin, 4)->score(*light);
  ASSERT_EQ(score.hands.size(), 2u);
  for (const auto& hand : score.hands) {
    EXPECT_TRUE(hand.interior_px.empty());
    EXPECT_GT(hand.missing_px.size(), 500u);
  }
}

TEST(Judge, ScoresOtherFleshByWhatItsTextureMeans) {
  auto rig = rig_with("builtin:still");
  rig.twin.shape.bone_width_spread = 0.2;
  const auto twin = twin_of(rig);
  auto light = light_of(*twin, kLit_ns);
  const auto score = Judge::create(*twin, 4)->score(*light);
  ASSERT_EQ(score.hands.size(), 1u);
  EXPECT_GT(score.hands[0].interior_px.size(), 500u);
  EXPECT_LT(mean_of(score.hands[0].interior_px), 0.05) << "light drawn with the true flesh";
}

TEST(Judge, LightOnTheForearmIsNeitherCoverageNorSpill) {
  const auto twin = twin_of(rig_with("builtin:still"));
  const auto judge = Judge::create(*twin, 4);
  const auto score_with_patch = [&](int below_wrist_px) {
    Projected light;
    const auto wrist =
        calib::reference_rig().projector.pixel_of((*twin->landmarks(Side::left, kLit_ns))[0]);
    for (int y = 0; y < 20; ++y)
      for (int x = -10; x < 10; ++x)
        light.light(static_cast<int>(wrist.x) + x, static_cast<int>(wrist.y) + below_wrist_px + y);
    return judge->score(*light).hands[0];
  };
  const auto on_arm = score_with_patch(40);
  EXPECT_EQ(on_arm.lit_px, 0);
  EXPECT_EQ(on_arm.spill_px, 0);
  const auto on_hand = score_with_patch(-60);
  EXPECT_EQ(on_hand.lit_px, 400);
  EXPECT_EQ(on_hand.seam_px, 80) << "the edge of a 20 x 20 patch";
}

TEST(Judge, LightWithoutAHandIsSpill) {
  auto rig = rig_with("builtin:enter_leave");
  const auto twin = twin_of(rig);
  const auto judge = Judge::create(*twin, 4);
  bool was_away = false;
  for (std::int64_t display_ns = 0; display_ns < 10'000'000'000 && !was_away;
       display_ns += 100'000'000) {
    if (twin->joints(Side::left, display_ns) || twin->joints(Side::right, display_ns)) continue;
    was_away = true;
    Projected light;
    light->lit_ns = display_ns;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 30; ++x) light.light(500 + x, 300 + y);
    const auto score = judge->score(*light);
    EXPECT_TRUE(score.hands.empty());
    EXPECT_EQ(score.stray_px, 600);
  }
  EXPECT_TRUE(was_away);
}

TEST(Judge, OnlyTheRegionOfTheProjectionIsRead) {
  const auto twin = twin_of(rig_with("builtin:still"));
  const auto judge = Judge::create(*twin, 4);
  const auto palm =
      calib::reference_rig().projector.pixel_of((*twin->landmarks(Side::left, kLit_ns))[9]);
  Projected light;
  light->region_x_px = static_cast<int>(palm.x) - 5;
  light->region_y_px = static_cast<int>(palm.y) - 5;
  light->region_width_px = light->region_height_px = 10;
  std::fill_n(light->pixels(), 100, 0xff000000u);
  light->pixels()[55] = 0x00ffffffu;
  const auto hand = judge->score(*light).hands[0];
  EXPECT_EQ(hand.lit_px, 99);
  EXPECT_EQ(hand.seam_px, 40 + 4);
}

}  // namespace
}  // namespace handcast::twin
