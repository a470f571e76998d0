// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace handcast::calibrate {
namespace {

using nlohmann::json;

TEST(Findings, AnOutcomeIsPrintedWithItsPictures) {
  const Outcome outcome{.made = "15 images",
                        .findings = {"image 3 was left out"},
                        .pictures = {{"depths", "Errors", {{"depth_m", {0.6, 0.8}}}}},
                        .meaning = "good is at most 0.6 px"};
  const auto printed = json::parse(print_outcome(outcome));
  EXPECT_EQ(printed["made"], "15 images");
  EXPECT_EQ(printed["findings"], json({"image 3 was left out"}));
  EXPECT_EQ(printed["meaning"], "good is at most 0.6 px");
  EXPECT_EQ(printed["pictures"][0]["kind"], "depths");
  EXPECT_EQ(printed["pictures"][0]["numbers"]["depth_m"], json({0.6, 0.8}));
}

TEST(Findings, AReportNamesItsStepsAndWhatACommandNeedsToGoOn) {
  const std::vector<Reported> steps{{Step::lens, "2026-01-01: 15 images", true},
                                    {Step::screen, "", false}};
  const auto printed =
      json::parse(print_report("show", {"rig.toml", "charuco:11x8:25", ""}, steps));
  EXPECT_EQ(printed["rig"], "show");
  EXPECT_EQ(printed["rig_file"], "rig.toml");
  EXPECT_EQ(printed["board"], "charuco:11x8:25");
  ASSERT_EQ(printed["steps"].size(), 2U);
  EXPECT_EQ(printed["steps"][0]["step"], "lens");
  EXPECT_EQ(printed["steps"][0]["made"], "2026-01-01: 15 images");
  EXPECT_EQ(printed["steps"][1]["is_done"], false);
}

TEST(Findings, NamesThatAreNoUtf8AndFiguresThatAreNoNumbersAreStillJson) {
  const auto report = json::parse(print_report("\xff", {"\xc3.toml", {}, {}}, {}));
  EXPECT_EQ(report["rig"], "\ufffd");
  const auto outcome = json::parse(print_outcome({.pictures = {{"bars", "", {{"x", {NAN}}}}}}));
  EXPECT_TRUE(outcome["pictures"][0]["numbers"]["x"][0].is_null());
}

TEST(Findings, VeryManyDotsAreThinnedOut) {
  const std::vector<glm::dvec2> dots(50000, glm::dvec2(1, 2));
  auto picture = dots_picture(720, 540, dots, "Hands.");
  EXPECT_GE(picture.numbers["right_px"].size(), 1000U);
  EXPECT_LE(picture.numbers["right_px"].size(), 2000U);
  EXPECT_EQ(picture.numbers["down_px"].size(), picture.numbers["right_px"].size());
  EXPECT_EQ(picture.numbers["size_px"], (std::vector<double>{720, 540}));
}

TEST(Findings, ViewsThatTookNoPartAreMarked) {
  struct View {
    double rms_px;
    std::string rejected;
  };
  auto picture = errors_picture(std::vector<View>{{0.1, ""}, {0.85, "blurred"}}, "Errors.");
  EXPECT_EQ(picture.numbers["rms_px"], (std::vector<double>{0.1, 0.85}));
  EXPECT_EQ(picture.numbers["is_left_out"], (std::vector<double>{0, 1}));
}

}  // namespace
}  // namespace handcast::calibrate
