// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/options.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <vector>

namespace handcast::calibrate {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

Result<Options> parsed(std::vector<std::string> words) {
  words.insert(words.begin(), "handcast calibrate");
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  return parse(static_cast<int>(arguments.size()), arguments.data());
}
std::string refusal(std::vector<std::string> words) {
  const auto options = parsed(std::move(words));
  return options ? "" : options.error().what;
}

TEST(CalibrateOptions, WhatDoesSomethingElseStandsAlone) {
  EXPECT_EQ(parsed({"rig.toml", "tracker", "--reflector", "8"})->reflector_mm, 8);
  EXPECT_THAT(refusal({"rig.toml", "--reflector", "0"}), HasSubstr("--reflector"));
  EXPECT_EQ(parsed({"rig.toml", "--points", "data"})->points, "data");
  EXPECT_TRUE(parsed({"rig.toml", "--correct"})->correct);
  EXPECT_TRUE(parsed({"rig.toml", "--undo"})->undo);
  EXPECT_THAT(refusal({"rig.toml", "--undo", "--correct"}), HasSubstr("choose one"));
  EXPECT_THAT(refusal({"rig.toml", "tracker", "--points", "data"}), HasSubstr("no single steps"));
}

TEST(CalibrateOptions, AnOptionWithoutEffectIsRefused) {
  for (const auto& [words, sentence] :
       {std::pair(std::vector<std::string>{"rig.toml", "--undo", "--apply"},
                  "--undo does not take --apply; leave it out"),
        {{"rig.toml", "--check", "--apply"}, "--check does not take --apply; leave it out"},
        {{"rig.toml", "--correct", "--reflector", "8"}, "--correct does not take --reflector"},
        {{"rig.toml", "--check", "--restart"}, "--check does not take --restart"},
        {{"rig.toml", "--check", "--camera", "64x64"}, "--check does not take --camera"},
        {{"rig.toml", "--points", "data", "--board", "charuco:11x8:20"},
         "--points does not take --board"},
        {{"rig.toml", "--undo", "--folder", "f"}, "--undo does not take --folder"},
        {{"--print-board", "b.pdf", "--check"}, "different things; choose one"},
        {{"rig.toml", "--check", "--second-projector"},
         "--check does not take --second-projector; leave it out"},
        {{"rig.toml", "screen", "lens", "--second-projector"},
         "--second-projector measures screen and light; lens is measured without it"},
        {{"rig.toml", "--second-projector", "--reflector", "8"}, "measures no tracker"},
        {{"rig.toml", "lens", "--reflector", "8"}, "--reflector belongs to the step `tracker`"},
        {{"rig.toml", "lens", "--photodiode", "hw:1"}, "--photodiode belongs to the step `light`"}})
    EXPECT_THAT(refusal(words), HasSubstr(sentence)) << words[1];
  EXPECT_EQ(refusal({"rig.toml", "--check", "--set", "a=1", "--yes", "--most-s", "9", "--reflector",
                     "8", "--board", "charuco:11x8:20"}),
            "");
  EXPECT_EQ(refusal({"rig.toml", "--correct", "--set", "a=1", "--yes", "--most-s", "9"}), "");
  EXPECT_EQ(refusal({"rig.toml", "--photodiode", "hw:1", "--reflector", "8", "--apply"}), "");
}

TEST(CalibrateOptions, ARigFileIsEnough) {
  const auto options = parsed({"show/rig.toml"});
  ASSERT_TRUE(options) << options.error().what;
  EXPECT_TRUE(options->steps.empty());
  EXPECT_EQ(options->folder, "show/rig.calibration");
  EXPECT_EQ(options->board.columns, 11);
}

TEST(CalibrateOptions, StepsBoardAndSizesAreRead) {
  const auto options =
      parsed({"rig.toml", "screen", "tracker", "--board", "checkerboard:9x6:24.5", "--camera",
              "1280x1024", "--camera2", "640x480", "--projector", "1920x1080"});
  ASSERT_TRUE(options) << options.error().what;
  EXPECT_THAT(options->steps, ElementsAre(Step::screen, Step::tracker));
  EXPECT_EQ(options->board.kind, calib::BoardKind::checkerboard);
  EXPECT_EQ(options->board.square_mm, 24.5);
  EXPECT_EQ(options->camera.height_px, 1024);
  EXPECT_EQ(options->camera2.width_px, 640);
  EXPECT_EQ(options->projector.width_px, 1920);
}

TEST(CalibrateOptions, SizesAreThoseOfACalibrationFile) {
  for (const auto* size : {"16x16", "8192x8192"})
    EXPECT_EQ(refusal({"rig.toml", "--camera", size, "--projector", size}), "") << size;
  for (const auto* size : {"15x16", "16x15", "8193x16", "16x8193", "100000x100000", "-16x16"})
    EXPECT_EQ(
        refusal({"rig.toml", "--projector", size}),
        fmt::format("--projector: '{}' is not a size like 1024x768, with 16 to 8192 px on a side",
                    size));
}

TEST(CalibrateOptions, WhatIsWrongIsSaidInASentence) {
  EXPECT_THAT(refusal({}), EndsWith("name the rig file: handcast calibrate RIG.toml"));
  EXPECT_THAT(refusal({"--undo"}), EndsWith("handcast calibrate RIG.toml --undo"));
  EXPECT_THAT(refusal({"--check"}), EndsWith("handcast calibrate RIG.toml --check"));
  EXPECT_THAT(refusal({"rig.toml", "lense"}),
              HasSubstr("there are lens, lens2, pair, screen, tracker, light"));
  EXPECT_THAT(refusal({"rig.toml", "--camera", "1280"}), HasSubstr("--camera: '1280'"));
  EXPECT_THAT(refusal({"rig.toml", "--camera", "1280x1024x3"}), HasSubstr("--camera"));
  EXPECT_THAT(refusal({"rig.toml", "--board", "chess:9x6:24"}),
              HasSubstr("--board: 'chess:9x6:24'"));
  EXPECT_THAT(refusal({"rig.toml", "--board", "charuco:9x6"}), HasSubstr("--board"));
  EXPECT_THAT(refusal({"rig.toml", "lens", "--check"}), HasSubstr("--check"));
  EXPECT_THAT(refusal({"rig.toml", "--most-s", "0"}), HasSubstr("--most-s"));
}

TEST(CalibrateOptions, TheBoardIsPrintedWithoutARig) {
  const auto options = parsed({"--print-board", "board.pdf"});
  ASSERT_TRUE(options) << options.error().what;
  EXPECT_EQ(options->board_pdf, "board.pdf");
}

}  // namespace
}  // namespace handcast::calibrate
