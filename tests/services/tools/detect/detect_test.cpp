// SPDX-License-Identifier: Apache-2.0
// handcast detect: landmarks of pictures, printed and drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "services/recording/arrays/recorded_hands.hpp"
#include "services/tools/detect/run.hpp"
#include "tests/scratch.hpp"
#include "tests/services/landmarks/pictures.hpp"
#include "tests/system/variable.hpp"

namespace handcast::detect {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Detect : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_MODELS();
    SKIP_WITHOUT_CAPTURES();
    options_.models = test::models();
    options_.quiet = true;
    for (const int number : {1, 6}) {
      options_.images.push_back(real() / fmt_name(number, "camera.png"));
      joints_.push_back(real() / fmt_name(number, "joints_2d_left.npy"));
    }
  }
  static fs::path real() {
    const char* data = std::getenv("HANDCAST_DATA");
    return fs::path(data ? data : "../shared/data") / "real";
  }
  static std::string fmt_name(int number, const char* rest) {
    return std::to_string(number) + "_" + rest;
  }

  /// The capture of a left hand as a picture of a right one.
  fs::path mirrored(int number) {
    const auto seen = renderer::read_picture(real() / fmt_name(number, "camera.png"));
    if (!seen) return {};
    renderer::Texture turned(seen->width(), seen->height());
    for (int y = 0; y < seen->height(); ++y)
      for (int x = 0; x < seen->width(); ++x) turned.at(x, y) = seen->at(seen->width() - 1 - x, y);
    auto file = scratch_.path() / ("mirrored_" + std::to_string(number) + ".png");
    return renderer::write_png(file, turned.view()) ? file : fs::path();
  }
  /// "left right ": those of the hands of a report, in its order.
  static std::string sides_in(const std::string& text) {
    std::string sides;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      for (const std::string side : {"left ", "right "})
        if (line.starts_with("  " + side + "hand, presence")) sides += side;
    return sides;
  }

  test::Scratch scratch_;
  Options options_;
  std::vector<fs::path> joints_;
};

TEST_F(Detect, PrintsEveryHandOfEveryPicture) {
  const auto text = run(options_);
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_THAT(text->text, HasSubstr("1_camera.png: 1 hand, "));
  EXPECT_THAT(text->text, HasSubstr("6_camera.png: 1 hand, "));
  EXPECT_THAT(text->text, HasSubstr("left hand, presence 0.9"));
  EXPECT_THAT(text->text, HasSubstr("palm "));
}

TEST_F(Detect, TellsProgramsTheSameAsJson) {
  options_.json = true;
  options_.joints = joints_;
  const auto text = run(options_);
  ASSERT_TRUE(text) << text.error().what;
  const auto images = nlohmann::json::parse(text->text).at("images");
  ASSERT_EQ(images.size(), 2u);
  const auto& hand = images[1].at("hands").at(0);
  EXPECT_EQ(hand.at("side"), "left");
  ASSERT_EQ(hand.at("points_px").size(), 21u);
  EXPECT_NEAR(hand.at("points_px")[12][0].get<double>(), 286, 6) << "the middle finger's tip";
  EXPECT_NEAR(hand.at("points_px")[12][1].get<double>(), 93, 6);
  EXPECT_GT(images[0].at("ms").at("network").get<double>(), 0);
  EXPECT_EQ(images[0].at("ms").at("palm").get<double>(), 0) << "the tracker said where";
}

TEST_F(Detect, DrawsIntoTheFolder) {
  options_.output = scratch_.path() / "drawn";
  ASSERT_TRUE(run(options_));
  const auto picture = renderer::read_picture(options_.output / "6_camera.png");
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->width(), 1024);
  const auto is_grey = [](std::uint32_t rgba) {
    return (rgba & 255) == (rgba >> 8 & 255) && (rgba & 255) == (rgba >> 16 & 255);
  };
  EXPECT_GT(std::ranges::count_if(picture->pixels(), [&](auto pixel) { return !is_grey(pixel); }),
            2000);
}

TEST_F(Detect, TwoPicturesOfOneNameAreDrawnBesideEachOther) {
  options_.images[1] = options_.images[0];
  options_.output = scratch_.path();
  ASSERT_TRUE(run(options_));
  EXPECT_TRUE(fs::exists(scratch_.path() / "1_camera.png"));
  EXPECT_TRUE(fs::exists(scratch_.path() / "1_camera_2.png"));
}

TEST_F(Detect, ANumberedDrawingIsNotDrawnOverByAPictureOfThatName) {
  fs::copy_file(options_.images[1], scratch_.path() / "1_camera_2.png");
  options_.images = {options_.images[0], options_.images[0], scratch_.path() / "1_camera_2.png"};
  options_.output = scratch_.path() / "drawn";
  ASSERT_TRUE(run(options_));
  EXPECT_EQ(std::distance(fs::directory_iterator(options_.output), {}), 3);
}

TEST_F(Detect, APictureIsNotReplacedByItsDrawing) {
  const auto picture = scratch_.path() / "hand.png";
  fs::copy_file(options_.images[0], picture);
  const auto bytes = fs::file_size(picture);
  options_.images = {picture};
  options_.joints.resize(1);
  options_.output = scratch_.path() / ".";
  const auto text = run(options_);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, Errc::bad_config);
  EXPECT_THAT(text.error().what, HasSubstr("would replace the picture"));
  EXPECT_EQ(fs::file_size(picture), bytes);
}

TEST_F(Detect, ANameThatIsNotUtf8IsPrintedAsJsonAllTheSame) {
  fs::copy_file(options_.images[0], scratch_.path() / "caf\xe9.png");
  options_.images = {scratch_.path() / "caf\xe9.png"};
  options_.json = true;
  const auto text = run(options_);
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_THAT(text->text, HasSubstr("caf\xef\xbf\xbd.png"));
}

TEST_F(Detect, JointsMayBe21PointsInPixels) {
  const auto capture = test::capture(1);
  std::vector<float> values;
  for (const auto& point : capture->tracker_px) values.insert(values.end(), {point.x, point.y});
  ASSERT_TRUE(recording::write_npy_f32(scratch_.path() / "joints.npy", {21, 2}, values));
  const auto read = read_joints(scratch_.path() / "joints.npy", 1024, 768);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ((*read)[20], capture->tracker_px[20]);
}

TEST_F(Detect, WhatWasFoundBeforeABadPictureIsPrinted) {
  options_.images.insert(options_.images.begin() + 1, scratch_.path() / "nowhere.png");
  options_.joints.clear();
  testing::internal::CaptureStdout();
  const auto text = run(options_);
  const auto printed = testing::internal::GetCapturedStdout();
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().what, HasSubstr("nowhere.png"));
  EXPECT_THAT(printed, HasSubstr("1_camera.png: 1 hand"));
}

TEST_F(Detect, SaysWhatItCannotUse) {
  const auto refused = [&](const Options& options) {
    const auto text = run(options);
    return text ? std::string("nothing") : text.error().what;
  };
  Options options = options_;
  options.images[1] = scratch_.path() / "nowhere.png";
  EXPECT_THAT(refused(options), HasSubstr("nowhere.png"));
  std::ofstream(scratch_.path() / "text.png") << "not a picture";
  options.images[1] = scratch_.path() / "text.png";
  EXPECT_THAT(refused(options), HasSubstr("text.png"));
  options = options_;
  options.joints = {joints_[0]};
  EXPECT_THAT(refused(options), HasSubstr("2 pictures, but 1 files of joints"));
  options.joints = {real() / "1_bones_left.npy", joints_[1]};
  EXPECT_THAT(refused(options), HasSubstr("expected (21, 2) or (42, 2)"));
  options = options_;
  options.models = scratch_.path();
  EXPECT_THAT(refused(options), HasSubstr("is missing; scripts/get-models"));
  options = options_;
  options.backend = "abacus";
  EXPECT_THAT(refused(options), HasSubstr("no landmark model 'abacus'; there are: handcast, medi"));
}

TEST_F(Detect, HandcastsModelNeedsNoFileFromOutsideIfThereIsATracker) {
  options_.backend = "handcast";
  options_.models = scratch_.path();
  options_.joints = joints_;
  const auto text = run(options_);
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_THAT(text->text, HasSubstr("1_camera.png: 1 hand, "));
  EXPECT_THAT(text->text, HasSubstr("6_camera.png: 1 hand, "));
}

TEST_F(Detect, WithoutATrackerAndAPalmNetworkTheHandIsSearchedInTheBrightParts) {
  options_.backend = "handcast";
  options_.models = scratch_.path();  // holds no file
  options_.images = {mirrored(1), options_.images[0], options_.images[1], mirrored(6)};
  const auto report = run(options_);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_TRUE(report->has_hand);
  EXPECT_THAT(report->text, HasSubstr("mirrored_1.png: 1 hand, "));
  EXPECT_THAT(report->text, HasSubstr("1_camera.png: 1 hand, "));
  EXPECT_THAT(report->text, HasSubstr("6_camera.png: 1 hand, "));
  EXPECT_THAT(report->text, HasSubstr("mirrored_6.png: 1 hand, "));
  const auto sides = sides_in(report->text);
  EXPECT_EQ(sides, "right left left right ");
}

TEST_F(Detect, APictureWithoutAHandSaysWhy) {
  renderer::Texture dark(320, 240);
  std::ranges::fill(dark.pixels(), 0xff101010u);
  const auto file = scratch_.path() / "dark.png";
  ASSERT_TRUE(renderer::write_png(file, dark.view()));
  options_.images = {file};
  options_.backend = "handcast";
  options_.models = scratch_.path();
  const auto report = run(options_);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_FALSE(report->has_hand);
  EXPECT_THAT(report->text, HasSubstr("dark.png: 0 hands"));
  EXPECT_THAT(report->text, HasSubstr("no part of it is bright before a dark background"));
  options_.joints = {joints_[0]};
  const auto with_joints = run(options_);
  ASSERT_TRUE(with_joints) << with_joints.error().what;
  EXPECT_THAT(with_joints->text, HasSubstr("sees no hand where --joints has it"));
  options_.joints.clear();
  options_.backend = "mediapipe";
  options_.models = test::models();
  options_.json = true;
  const auto as_json = run(options_);
  ASSERT_TRUE(as_json) << as_json.error().what;
  EXPECT_THAT(nlohmann::json::parse(as_json->text)["images"][0]["why_none"].get<std::string>(),
              HasSubstr("palm network finds no palm"));
}

TEST_F(Detect, WithoutAChoiceAndMediapipesFilesItTakesHandcastsModelAndSaysSo) {
  const system_test::Variable no_files("HANDCAST_MODELS", scratch_.path().string());
  options_.models.clear();
  options_.quiet = false;
  options_.joints = joints_;
  testing::internal::CaptureStderr();
  const auto text = run(options_);
  EXPECT_THAT(
      testing::internal::GetCapturedStderr(),
      testing::AllOf(HasSubstr("with handcast's own network, because "), HasSubstr("is missing")));
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_THAT(text->text, HasSubstr("1_camera.png: 1 hand, "));
}

TEST_F(Detect, IsAVerbWithTheUsualExitCodes) {
  const char* bin = std::getenv("HANDCAST_BIN");
  const std::string program = std::string(bin ? bin : "bin") + "/handcast-detect ";
  if (!fs::exists(program.substr(0, program.size() - 1)))
    GTEST_SKIP() << "no handcast-detect in " << program;
  const auto exit_code = [&](const std::string& arguments) {
    return WEXITSTATUS(std::system((program + arguments + " >/dev/null 2>&1").c_str()));
  };
  EXPECT_EQ(exit_code("--help"), 0);
  const std::string image = " " + options_.images[0].string();
  EXPECT_EQ(exit_code("--backend mediapipe --model " + options_.models + image), 0);
  EXPECT_EQ(exit_code("--backend mediapipe --model " + scratch_.path().string() + image), 100);
  renderer::Texture dark(64, 64);
  const auto file = scratch_.path() / "dark.png";
  ASSERT_TRUE(renderer::write_png(file, dark.view()));
  EXPECT_EQ(exit_code("--backend mediapipe --model " + options_.models + " " + file.string()), 1);
  EXPECT_NE(exit_code("--abacus --model " + options_.models + image), 0);
}

}  // namespace
}  // namespace handcast::detect
