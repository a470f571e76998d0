// SPDX-License-Identifier: Apache-2.0
#include "config/settings/renamed.hpp"

#include <gmock/gmock.h>

#include "config/settings/load.hpp"

namespace handcast::config {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::array kTable{
    Renamed{.old = {"eye.kind", "mk1"}, .now = {"eye.kind", "pinhole"}},
    Renamed{
        .old = {"eye.kind", "mk2"}, .now = {"eye.kind", "fisheye"}, .also = {"eye.model", "wide"}},
    Renamed{.old = {"eye.fps"}, .now = {"eye.pace.rate_hz"}},
    Renamed{.old = {"lamp.power"}, .now = {"light_w"}},
};

struct Pace {
  double rate_hz = 1;
};
template <class Visitor>
void describe(Visitor& visitor, Pace& pace) {
  visitor.field("rate_hz", pace.rate_hz, between(1, 100, "Hz"), "How often.");
}
struct Eye {
  std::string kind, model;
  Pace pace;
};
template <class Visitor>
void describe(Visitor& visitor, Eye& eye) {
  visitor.field("kind", eye.kind, "Which lens.");
  visitor.field("model", eye.model, "Which model of it.");
  visitor.section("pace", eye.pace, "Its rhythm.");
}
struct Head {
  double light_w = 0;
  Eye eye;
};
template <class Visitor>
void describe(Visitor& visitor, Head& head) {
  visitor.field("light_w", head.light_w, at_least(0, "W"), "The lamp.");
  visitor.section("eye", head.eye, "The camera.");
}

/// A file read through the table.
struct Loaded {
  Head head;
  std::vector<std::string> sentences;
  std::string faults;
};

Loaded load(const std::string& toml) {
  Loaded loaded;
  auto document = parse_document(toml, "head.toml").value();
  replace_renamed(document, "head.toml", kTable,
                  [&](const std::string& sentence) { loaded.sentences.push_back(sentence); });
  Faults faults;
  apply_document(document, "head.toml", list_settings(loaded.head), faults);
  loaded.faults = faults.to_error().what;
  return loaded;
}

TEST(Renamed, AFileInTheNewFormIsReadInSilence) {
  const auto loaded = load("light_w = 3\n[eye]\nkind = 'pinhole'\npace.rate_hz = 5\n");
  EXPECT_THAT(loaded.sentences, IsEmpty());
  EXPECT_EQ(loaded.faults, "");
  EXPECT_EQ(loaded.head.eye.kind, "pinhole");
}

TEST(Renamed, AnOldWordIsReadAsTheNewOneAndReportedOnceWithItsPlace) {
  const auto loaded = load("\n[eye]\nkind = 'mk1'\n");
  EXPECT_EQ(loaded.faults, "");
  EXPECT_EQ(loaded.head.eye.kind, "pinhole");
  EXPECT_THAT(loaded.sentences, ElementsAre("head.toml:3: eye.kind = \"mk1\" is now \"pinhole\""));
}

TEST(Renamed, AnOldWordMayStandForTwoSettings) {
  const auto loaded = load("eye.kind = 'mk2'\n");
  EXPECT_EQ(loaded.head.eye.kind, "fisheye");
  EXPECT_EQ(loaded.head.eye.model, "wide");
  EXPECT_THAT(
      loaded.sentences,
      ElementsAre("head.toml:1: eye.kind = \"mk2\" is now \"fisheye\" with eye.model = \"wide\""));
}

TEST(Renamed, WhatTheFileSaysOfTheSecondSettingStays) {
  EXPECT_EQ(load("[eye]\nmodel = 'narrow'\nkind = 'mk2'\n").head.eye.model, "narrow");
}

TEST(Renamed, ASettingKeepsItsValueUnderItsNewName) {
  const auto loaded = load("[eye]\nfps = 25\n[lamp]\npower = 7.5\n");
  EXPECT_EQ(loaded.faults, "") << "and an old section that became empty is gone";
  EXPECT_EQ(loaded.head.eye.pace.rate_hz, 25);
  EXPECT_EQ(loaded.head.light_w, 7.5);
  EXPECT_THAT(loaded.sentences, ElementsAre("head.toml:2: eye.fps is now eye.pace.rate_hz",
                                            "head.toml:4: lamp.power is now light_w"));
}

TEST(Renamed, TheNewNameWinsOverTheOldOne) {
  EXPECT_EQ(load("[eye]\nfps = 25\npace.rate_hz = 50\n").head.eye.pace.rate_hz, 50);
}

TEST(Renamed, AFaultIsReportedAtTheLineOfTheOldSetting) {
  EXPECT_EQ(load("\n\n[eye]\nfps = 0\n").faults,
            "head.toml:4: eye.pace.rate_hz: 0 is outside 1..100 Hz");
  EXPECT_EQ(load("[lamp]\npower = 1\ncolour = 2\n").faults,
            "head.toml:1: lamp: there is no such setting");
}

TEST(Renamed, AValueThatIsNoWordOrASectionThatIsNoneIsLeftToTheLoader) {
  EXPECT_EQ(load("eye.kind = 5\n").faults,
            "head.toml:1: eye.kind: must be text in quotes, not a "
            "whole number");
  EXPECT_EQ(load("eye = 5\n").faults,
            "head.toml:1: eye: is a section, [eye], and cannot be a whole number");
  EXPECT_EQ(load("[eye]\nfps = 5\npace = 3\n").faults,
            "head.toml:3: eye.pace: is a section, [eye.pace], and cannot be a whole number");
}

std::vector<std::string> current(const std::string& assignment,
                                 std::vector<std::string>* sentences = nullptr) {
  return replace_renamed(assignment, kTable, [&](const std::string& sentence) {
    if (sentences) sentences->push_back(sentence);
  });
}

TEST(Renamed, AnAssignmentIsReplacedByOneOrTwo) {
  std::vector<std::string> sentences;
  EXPECT_THAT(current("eye.kind=pinhole", &sentences), ElementsAre("eye.kind=pinhole"));
  EXPECT_THAT(sentences, IsEmpty());
  EXPECT_THAT(current("eye.kind=mk1", &sentences), ElementsAre("eye.kind=pinhole"));
  EXPECT_THAT(current("eye.kind=\"mk2\"", &sentences),
              ElementsAre("eye.kind=fisheye", "eye.model=wide"));
  EXPECT_THAT(current("eye.fps=[1, 2]"), ElementsAre("eye.pace.rate_hz=[1, 2]"));
  EXPECT_THAT(sentences,
              ElementsAre("--set: eye.kind = \"mk1\" is now \"pinhole\"",
                          "--set: eye.kind = \"mk2\" is now \"fisheye\" with eye.model = "
                          "\"wide\""));
}

TEST(Renamed, WhatIsNoAssignmentStaysAsItIs) {
  EXPECT_THAT(current("eye.kind"), ElementsAre("eye.kind"));
  EXPECT_THAT(current(""), ElementsAre(""));
  EXPECT_THAT(current("eye.kind="), ElementsAre("eye.kind="));
}

}  // namespace
}  // namespace handcast::config
