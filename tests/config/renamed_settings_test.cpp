// SPDX-License-Identifier: Apache-2.0
// Old forms in rig files and assignments.
#include "config/renamed_settings.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "config/rig.hpp"
#include "config/settings/settings.hpp"

namespace handcast::config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// The rig and the sentences about its old forms.
std::pair<Rig, std::vector<std::string>> read(const std::string& toml,
                                              const std::vector<std::string>& settings = {}) {
  std::vector<std::string> sentences;
  const auto rig = parse_rig(toml, "rig.toml", settings,
                             [&](const std::string& sentence) { sentences.push_back(sentence); });
  EXPECT_TRUE(rig) << rig.error().what;
  return {rig.value_or(Rig{}), sentences};
}

TEST(RenamedSettings, TheBackEndOwnIsHandcast) {
  const auto [rig, sentences] = read("[landmarks]\nbackend = 'own'\n");
  EXPECT_EQ(rig.landmarks.backend, "handcast");
  EXPECT_THAT(sentences,
              ElementsAre("rig.toml:2: landmarks.backend = \"own\" is now \"handcast\""));
}

TEST(RenamedSettings, TheBackEndsOnednnAndOpencvAreMediapipe) {
  for (const char* name : {"onednn", "opencv"}) {
    const auto [rig, sentences] = read(fmt::format("landmarks.backend = '{}'\n", name));
    EXPECT_EQ(rig.landmarks.backend, "mediapipe");
    EXPECT_EQ(sentences.size(), 1u);
  }
}

TEST(RenamedSettings, AnAssignmentIsReportedWithoutALine) {
  EXPECT_THAT(read("", {"landmarks.backend=own"}).second,
              ElementsAre("--set: landmarks.backend = \"own\" is now \"handcast\""));
}

TEST(RenamedSettings, OtherBackEndsOfThatNameAreNotTouched) {
  EXPECT_EQ(read("camera.backend = 'opencv'\n").first.camera.backend, "opencv");
}

TEST(RenamedSettings, ARigIsPrintedInTheNewFormWhichIsReadInSilence) {
  const auto printed = print_rig(read("landmarks.backend = 'own'\n").first);
  EXPECT_THAT(printed, HasSubstr("backend = \"handcast\""));
  EXPECT_THAT(printed, Not(HasSubstr("\"own\"")));
  EXPECT_THAT(read(printed).second, testing::IsEmpty());
}

TEST(RenamedSettings, EachUseIsOneLineOfTheLogUnlessSomebodyElseListens) {
  testing::internal::CaptureStderr();
  ASSERT_TRUE(parse_rig("landmarks.backend = 'own'\n", "rig.toml"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::EndsWith("warning rig.toml:1: landmarks.backend = \"own\" is now "
                                "\"handcast\"\n"));
}

/// A row whose new form is not declared would make a good file a bad one.
TEST(RenamedSettings, EveryNewFormIsASettingAndNoOldFormIsOneOfItsWords) {
  Rig rig;
  const auto listing = list_settings(rig);
  for (const auto& row : renamed_settings()) {
    EXPECT_NE(find_setting(listing, row.now.setting), nullptr) << row.now.setting;
    if (!row.also.setting.empty()) {
      EXPECT_NE(find_setting(listing, row.also.setting), nullptr) << row.also.setting;
    }
    if (row.old.value.empty()) {
      EXPECT_EQ(find_setting(listing, row.old.setting), nullptr) << row.old.setting;
    }
    for (const auto& other : renamed_settings())
      EXPECT_FALSE(other.old.setting == row.now.setting && !row.now.value.empty() &&
                   other.old.value == row.now.value)
          << row.now.value << " is renamed once more";
  }
}

}  // namespace
}  // namespace handcast::config
