// SPDX-License-Identifier: Apache-2.0
#include "config/live/live_values.hpp"

#include <gmock/gmock.h>

namespace handcast::config {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::string changed(std::string_view values, const std::vector<std::string>& assignments) {
  const auto result = changed_values(Rig(), values, assignments);
  return result ? *result : "error: " + result.error().what;
}

TEST(LiveValues, AreWhatDiffersFromTheFile) {
  const auto once = changed("", {"projector.brightness=0.5", "cascade.fill.reach_px=5"});
  EXPECT_EQ(once, "projector.brightness = 0.5\ncascade.fill.reach_px = 5\n");
  EXPECT_EQ(changed(once, {"projector.brightness=1"}), "cascade.fill.reach_px = 5\n");
  EXPECT_EQ(changed(once, {"projector.brightness"}), "cascade.fill.reach_px = 5\n");
  EXPECT_EQ(changed(once, {"cascade.fill.reach_px=4"}),
            "projector.brightness = 0.5\ncascade.fill.reach_px = 4\n");
  const auto rig = with_live(Rig(), once);
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->projector.brightness, 0.5);
}

TEST(LiveValues, AllOrNoneAreChangedAndEachFaultIsNamed) {
  EXPECT_THAT(changed("", {"projector.brightness=2", "light.master=0.5", "light.freze=true"}),
              AllOf(HasSubstr("projector.brightness=2: 2 is outside 0..1"), HasSubstr("freeze")));
  EXPECT_THAT(changed("", {"camera.rate_hz=100"}), HasSubstr("handcast reload"));
  EXPECT_THAT(changed("", {"nothing"}), HasSubstr("handcast get"));
  EXPECT_THAT(changed("", {"cascade.filter.method=ideal"}), HasSubstr("simulate"));
  EXPECT_THAT(changed("", {"cascade.correct.bone_short_px=50"}), HasSubstr("bone_long_px"));
  EXPECT_THAT(changed("", {"light.keep_out=1 2, 3 4"}), HasSubstr("is not an area"));
}

TEST(LiveValues, TextsAreKept) {
  const auto values = changed("", {"content.left=text:a, 'b'"});
  const auto rig = with_live(Rig(), values);
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_EQ(rig->content.left, "text:a, 'b'");
}

TEST(LiveValues, ATextThatCouldNotBeReadAgainIsRefused) {
  EXPECT_THAT(changed("", {"content.left=text:Gr\xfc\xdf"
                           "e"}),
              HasSubstr("is not UTF-8"));
  const auto preset = values_of_preset(Rig(), "content.left = \"a.png\"", "/M\xfcller/p.toml");
  ASSERT_FALSE(preset);
  EXPECT_THAT(preset.error().what, HasSubstr("is not UTF-8"));
}

TEST(LiveValues, ThereIsAlwaysRoomForABlackout) {
  msg::LiveSettings settings;
  const std::string most(settings.values.bytes.size() - 1, 'x');
  EXPECT_FALSE(change(settings, most, "content.left = x", "test", kSecond_ns));
  EXPECT_TRUE(change(settings, most.substr(600), "content.left = x", "test", 2 * kSecond_ns));
  EXPECT_TRUE(change(settings, most.substr(100), "light.blackout = true", "test", 4 * kSecond_ns));
}

TEST(LiveValues, ChangesAreTakenBackAndDoneAgain) {
  msg::LiveSettings settings;
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(change(settings, std::to_string(i) + "\n", "a = " + std::to_string(i), "me",
                       i * 10 * kSecond_ns));
    settings.header.origin_ns = i * 10 * kSecond_ns;
  }
  ASSERT_TRUE(undo(settings, "me"));
  EXPECT_EQ(settings.values.view(), "2\n");
  ASSERT_TRUE(undo(settings, "me"));
  ASSERT_TRUE(redo(settings, "me"));
  EXPECT_EQ(settings.values.view(), "2\n");
  ASSERT_TRUE(undo(settings, "me"));
  ASSERT_TRUE(undo(settings, "me"));
  EXPECT_EQ(settings.values.view(), "");
  EXPECT_FALSE(undo(settings, "me"));
  ASSERT_TRUE(redo(settings, "me"));
  ASSERT_TRUE(change(settings, "4\n", "b = 4", "me", 100 * kSecond_ns));
  EXPECT_FALSE(redo(settings, "me")) << "there is another future now";
}

TEST(LiveValues, ASliderThatIsDraggedIsOneChange) {
  msg::LiveSettings settings;
  ASSERT_TRUE(change(settings, "0\n", "b = 0", "me", 1));
  for (int i = 1; i <= 100; ++i) {
    const auto at_ns = 10 * kSecond_ns + i * kSecond_ns / 60;
    ASSERT_TRUE(
        change(settings, std::to_string(i) + "\n", "a = " + std::to_string(i), "me", at_ns));
    settings.header.origin_ns = at_ns;
  }
  ASSERT_TRUE(undo(settings, "me"));
  EXPECT_EQ(settings.values.view(), "0\n");
}

TEST(LiveValues, TheOldestChangesAreForgottenNotTheNewest) {
  msg::LiveSettings settings;
  const std::string long_text(3000, 'x');
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(
        change(settings, std::to_string(i) + long_text, "a = 1", "me", i * 10 * kSecond_ns));
  int steps = 0;
  while (undo(settings, "me")) {
    EXPECT_EQ(settings.values.view(), std::to_string(98 - steps) + long_text);
    ++steps;
  }
  EXPECT_EQ(steps, 10);
  EXPECT_FALSE(change(settings, std::string(20000, 'x'), "a = 1", "me", 0));
}

}  // namespace
}  // namespace handcast::config
