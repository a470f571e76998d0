// SPDX-License-Identifier: Apache-2.0
// Settings that change while the light is on.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "config/rig.hpp"
#include "config/settings/settings.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/output/dark_areas.hpp"
#include "tests/renderer/pipeline/driven_pipeline.hpp"

namespace handcast::renderer {
namespace {

/// The light of some frames.
using Light = std::vector<std::uint32_t>;

/// A hand that moves, with detections beside it and images of it, from `from_ns` for 150 ms.
/// Returns the light of its last frames.
Light play(Pipeline& pipeline, std::int64_t from_ns = 0) {
  const auto calibration = rig_above_hand();
  const auto at = [](std::int64_t time_ns) {
    return pose_of(Side::right,
                   {0.02f * std::sin(static_cast<float>(time_ns) * 2e-8f), -0.1f, 0.01f});
  };
  Light light;
  Image<std::uint8_t> image;
  std::int64_t image_ns = 0;
  for (std::int64_t t = from_ns; t < from_ns + 150 * kMs; t += 5 * kMs) {
    if (t % (10 * kMs) == 0) pipeline.push(t + 9 * kMs, poses_of(t, {at(t)}));
    if (t % (15 * kMs) == 0)
      pipeline.push(t + 9 * kMs, landmarks_of(calibration, t, at(t), {6, 4}));
    if (t % (10 * kMs) == 0) {
      image = image_of(calibration, {at(t)}, {6, 4});
      image_ns = t;
    }
    const auto frame = pipeline.render(
        t + 10 * kMs, t + 14 * kMs,
        {std::as_const(image).view(), image_ns, static_cast<std::uint64_t>(image_ns)});
    if (t < from_ns + 140 * kMs) continue;
    for (int y = frame.region.y0; y < frame.region.y1; ++y)
      light.insert(light.end(), frame.colour.row(y) + frame.region.x0,
                   frame.colour.row(y) + frame.region.x1);
  }
  return light;
}

/// Other values of a setting.
std::vector<std::function<void()>> changes_of(const config::Setting& setting) {
  std::vector<std::function<void()>> changes;
  if (auto* const* flag = std::get_if<bool*>(&setting.target))
    changes.push_back([flag = *flag] { *flag = !*flag; });
  if (auto* const* number = std::get_if<double*>(&setting.target))
    changes.push_back([number = *number, range = setting.range] {
      *number = *number > range.min ? *number * 0.5 + range.min * 0.5 : range.min + 1;
    });
  if (auto* const* number = std::get_if<int*>(&setting.target))
    changes.push_back([number = *number, range = setting.range] {
      *number += *number + 3 <= range.max ? 3 : -1;
    });
  if (const auto* choice = std::get_if<config::ChoiceTarget>(&setting.target))
    for (std::size_t i = 0; i < choice->words.size(); ++i)
      if (choice->words[i] != "ideal" && i != choice->index(choice->value))
        changes.push_back([choice = *choice, i] { choice.assign(choice.value, i); });
  return changes;
}

TEST(LiveSettings, APipelineThatIsAdjustedDrawsAsOneThatWasMadeSo) {
  config::Rig rig;
  rig.content.smooth = false;
  const auto plain = play(*make_pipeline());
  std::set<std::string> without_effect;
  int live = 0;
  for (const auto& section : config::list_settings(rig))
    for (const auto& setting : section.settings) {
      if (!setting.path.starts_with("cascade.") || setting.effect != config::Effect::live) continue;
      ++live;
      for (const auto& change : changes_of(setting)) {
        const config::Rig before = rig;
        change();
        SCOPED_TRACE(setting.path + " = " + config::print_value(setting));
        const auto made = play(*make_pipeline(rig.cascade, rig_above_hand(), rig.content));
        auto adjusted = make_pipeline();
        adjusted->adjust(rig.cascade, rig.content);
        EXPECT_TRUE(play(*adjusted) == made);
        if (made == plain) without_effect.insert(setting.path);
        rig = before;
      }
    }
  EXPECT_GT(live, 25);
  // Settings of methods that are not chosen, and of hands that this one is not.
  EXPECT_LT(without_effect.size(), 27u) << ::testing::PrintToString(without_effect);
}

TEST(LiveSettings, AChangeInTheMiddleKeepsWhatWasLearned) {
  auto pipeline = make_pipeline();
  play(*pipeline);
  config::Cascade settings;
  settings.fill.reach_px = 2;
  pipeline->adjust(settings, {.smooth = false});
  auto other = make_pipeline(settings);
  play(*other);
  EXPECT_TRUE(play(*pipeline, 150 * kMs) == play(*other, 150 * kMs));
}

/// A mirror of left and right in a picture of 1024 px, after a shift.
glm::dmat3 mirrored_and_shifted(double x_px, double y_px) {
  const glm::dmat3 shift(1, 0, 0, 0, 1, 0, x_px, y_px, 1), mirror(-1, 0, 0, 0, 1, 0, 1023, 0, 1);
  return mirror * shift;
}

TEST(LiveSettings, APipelineThatIsAimedDrawsAsOneThatIsCalibratedSo) {
  for (const auto& pixels : {mirrored_and_shifted(0, 0), mirrored_and_shifted(3.25, -7.5)}) {
    for (const double aside : {0., 4000.}) {
      auto calibration = rig_above_hand();
      calibration.projector.parallax = {aside / 100, 0, 0};
      auto aimed = make_pipeline({}, calibration);
      aimed->aim(pixels);
      auto moved = calibration;
      moved.projector = moved.projector.moved(pixels);
      const auto light = play(*aimed);
      EXPECT_TRUE(light == play(*make_pipeline({}, moved)));
      EXPECT_FALSE(light == play(*make_pipeline({}, calibration)));
    }
  }
}

TEST(LiveSettings, APictureIsMirroredAndShiftedAndBackAgain) {
  auto pipeline = make_pipeline(cascade(config::CorrectMethod::vertices, config::FillMethod::none));
  feed_still(*pipeline, {pose_of(Side::right)});
  const auto draw = [&](Image<std::uint32_t>& picture) {
    picture = Image<std::uint32_t>(1024, 768);
    const auto frame = pipeline->render(110 * kMs, 110 * kMs, {});
    for (int y = 0; y < 768; ++y)
      for (int x = 0; x < 1024; ++x) picture.at(x, y) = lit(frame, x, y);
    return lit_pixels(frame);
  };
  Image<std::uint32_t> plain, aimed, again;
  const int all_px = draw(plain);
  pipeline->aim(mirrored_and_shifted(5, 2));
  draw(aimed);
  int wrong_px = 0;
  for (int y = 2; y < 768; ++y)
    for (int x = 5; x < 1024; ++x) wrong_px += aimed.at(1023 - x, y) != plain.at(x - 5, y - 2);
  EXPECT_LT(wrong_px, all_px / 200) << "but for rounding at edges";
  pipeline->aim(glm::dmat3(1));
  draw(again);
  EXPECT_TRUE(std::ranges::equal(again.pixels(), plain.pixels()));
}

TEST(LiveSettings, DarkAreasStayWhereTheyAreInAPictureThatIsMirrored) {
  auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::right)});
  const Rect dark{0, 0, 512, 768};
  pipeline->keep_dark({dark});
  pipeline->aim(mirrored_and_shifted(0, 0));
  const auto frame = pipeline->render(110 * kMs, 110 * kMs, {});
  EXPECT_EQ(lit_pixels(frame, dark), 0);
  EXPECT_GT(lit_pixels(frame), 0);
}

TEST(LiveSettings, DarkAreasStayDark) {
  auto pipeline = make_pipeline();
  feed_still(*pipeline, {pose_of(Side::right)});
  auto frame = pipeline->render(110 * kMs, 110 * kMs, {});
  const Rect region = frame.region;
  const double x = (region.x0 + region.x1) / 2.;
  const std::vector<config::Polygon> areas{{{x, -100.}, {2000., -100.}, {2000., 900.}, {x, 900.}}};
  const auto left_px = lit_pixels(frame, {0, 0, static_cast<int>(x), 768});
  ASSERT_GT(lit_pixels(frame), left_px);
  pipeline->keep_dark(dark_areas(areas, 1024, 768));
  frame = pipeline->render(112 * kMs, 112 * kMs, {});
  EXPECT_EQ(lit_pixels(frame), lit_pixels(frame, {0, 0, static_cast<int>(std::ceil(x)), 768}));
  EXPECT_GT(lit_pixels(frame), 0);
  pipeline->keep_dark({});
  frame = pipeline->render(114 * kMs, 114 * kMs, {});
  EXPECT_GT(lit_pixels(frame), left_px);
}

}  // namespace
}  // namespace handcast::renderer
