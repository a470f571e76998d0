// SPDX-License-Identifier: Apache-2.0
// The looks that come with handcast.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "services/content/looks_folder.hpp"
#include "tests/scratch.hpp"
#include "tests/services/content/shader/look_stage.hpp"

namespace handcast::content {
namespace {

constexpr std::uint32_t kMagenta = 0xffff00ffu;

/// A look whose texels are magenta if a number of any pass is not finite.
std::string accusing(const std::string& name) {
  std::ifstream file(looks_folder() / (name + ".fs"));
  std::stringstream read;
  read << file.rdbuf();
  std::string text = read.str();
  const std::regex target(R"re("TARGET": "(\w+)")re");
  std::string sums = "0.0", last = "0";
  int targets = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), target), end; it != end; ++it, ++targets)
    sums += " + length(texture(" + (*it)[1].str() + ", isf_FragNormCoord))";
  last = std::to_string(targets);
  const auto at = text.find("void main()");
  EXPECT_NE(at, text.npos) << name;
  text.replace(at, 11, "void look()");
  return text +
         "\nbool is_bad(vec4 v) { return any(isnan(v)) || any(isinf(v)); }\n"
         "void main() {\n  look();\n  bool bad = is_bad(gl_FragColor);\n"
         "  if (PASSINDEX < " +
         last +
         " && bad) gl_FragColor = vec4(1.0e18);\n"
         "  if (PASSINDEX == " +
         last + " && (bad || " + sums + " > 1.0e17)) gl_FragColor = vec4(1.0, 0.0, 1.0, 1.0);\n}\n";
}

class LooksTest : public LookStage {
 protected:
  std::unique_ptr<Source> open(const std::string& name, Side side, int width, int height) {
    const auto file = scratch_.path() / (name + ".fs");
    std::ofstream(file) << accusing(name);
    return opened(opening_of("isf", file.string(), side, width, height));
  }

  /// Draws pictures 0.1 s apart. Returns the last one.
  renderer::Texture play(Source& source, Side side, double from_s, double to_s) {
    const auto& size = pictures_[0];
    renderer::Texture out(size.width(), size.height());
    const std::array inputs{std::as_const(pictures_[0]).view(), std::as_const(pictures_[1]).view()};
    const std::span given(inputs.data(), static_cast<std::size_t>(source.inputs()));
    for (double now = from_s; now < to_s; now += 0.1) {
      auto here = moment(side, now, frame_++);
      here.progress = 0.1 + 0.8 * now / 6;
      const auto drawn = source.draw(here, given, out);
      EXPECT_TRUE(drawn) << drawn.error().what;
      EXPECT_EQ(std::ranges::count(out.pixels(), kMagenta), 0) << "numbers that are not finite";
    }
    return out;
  }

  /// Loads a look, and sees it drawn and moving.
  void try_out(const std::string& name, Side side, int width, int height) {
    SCOPED_TRACE(name + (side == Side::left ? ", left hand" : ", right hand"));
    frame_ = 0;
    pictures_[0] = renderer::Texture(width, height, 0xff203040u);
    pictures_[1] = renderer::Texture(width, height, 0xffc0a080u);
    const auto source = open(name, side, width, height);
    const auto early = play(*source, side, 0, 3), late = play(*source, side, 3, 4.5);
    const auto lit = std::ranges::count_if(late.pixels(), [](std::uint32_t texel) {
      return level_of(texel, 0) + level_of(texel, 1) + level_of(texel, 2) > 90;
    });
    EXPECT_GT(lit, width * height / 100);
    // What depends on the pose alone stands still with the hand.
    if (name != "appearance") {
      EXPECT_NE(early.pixels(), late.pixels()) << "it stands still";
    }
  }

  test::Scratch scratch_;
  std::array<renderer::Texture, 2> pictures_;
  std::uint64_t frame_ = 0;
};

TEST_F(LooksTest, APassOfOnceIsDrawnAgainOnlyWhenASettingChanges) {
  const auto file = scratch_.path() / "once.fs";
  std::ofstream(file)
      << R"(/*{"INPUTS": [{"NAME": "blue", "TYPE": "float", "MIN": 0, "MAX": 1, "DEFAULT": 0}],
    "PASSES": [{"TARGET": "kept", "ONCE": true}, {}]}*/
    void main() {
      if (PASSINDEX == 0) gl_FragColor = vec4(TIME, 0.0, blue, 1.0);
      else gl_FragColor = IMG_THIS_PIXEL(kept) + vec4(0.0, TIME, 0.0, 0.0);
    })";
  const auto source = opened(opening_of("isf", file.string(), Side::left, 8, 8));
  renderer::Texture out(8, 8);
  const auto at = [&](double time_s) {
    EXPECT_TRUE(source->draw(moment(Side::left, time_s, frame_++), {}, out));
    return out.at(4, 4);
  };
  EXPECT_EQ(at(0.2), 0xff003333u);
  EXPECT_EQ(at(0.4), 0xff006633u);
  ASSERT_TRUE(source->set("blue", "1"));
  EXPECT_EQ(at(0.6), 0xffff9999u);
  EXPECT_EQ(at(0.8), 0xffffcc99u);
}

TEST_F(LooksTest, ThereAreTwelveAndMore) { EXPECT_GE(look_names().size(), 12u); }

// By which `handcast content` lists them.
TEST_F(LooksTest, AllSayWhatTheyAre) {
  constexpr std::array kCategories{"Generator", "Filter", "Transition"};
  for (const auto& name : look_names()) {
    const auto source = open(name, Side::left, 8, 8);
    std::ifstream file(looks_folder() / (name + ".fs"));
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const auto* const category = kCategories.at(static_cast<std::size_t>(source->inputs()));
    EXPECT_THAT(text, testing::HasSubstr("\"CATEGORIES\": [\"" + std::string(category) + "\"]"))
        << name;
  }
}

TEST_F(LooksTest, AllAreDrawnAndMoveOnBothHands) {
  for (const auto& name : look_names())
    for (const Side side : {Side::left, Side::right}) {
      pose("two_hands", 1.5);
      ASSERT_TRUE(both_[0].is_there && both_[1].is_there);
      try_out(name, side, 160, 100);
    }
}

TEST_F(LooksTest, AllAreDrawnAndMoveInASquare) {
  pose("pinch", 1);
  for (const auto& name : look_names()) try_out(name, Side::left, 128, 128);
}

TEST_F(LooksTest, WaterRunsOffWhenTheFingersPointDown) {
  pose("open_close", 0.1);
  pictures_.fill(renderer::Texture(160, 100));
  const auto source = open("water", Side::left, 160, 100);
  const auto light_in = [](const renderer::Texture& picture) {
    double sum = 0;
    for (const auto texel : picture.pixels()) sum += level_of(texel, 1) + level_of(texel, 2);
    return sum;
  };
  both_[0].gravity = {0, 0, 1};
  const double full = light_in(play(*source, Side::left, 0, 6));
  both_[0].gravity = {0, 0, -1};
  EXPECT_LT(light_in(play(*source, Side::left, 6, 18)), 0.5 * full);
  both_[0].gravity = {0, 0, 1};
  EXPECT_GT(light_in(play(*source, Side::left, 18, 60)), 0.7 * full);
}

TEST_F(LooksTest, WithoutAHandAllAreFinite) {
  both_ = Hands::load({}, GesturingHands("show").calibration())->at(GesturingHands::ns(1));
  ASSERT_FALSE(both_[0].is_there);
  for (const auto& name : look_names()) {
    SCOPED_TRACE(name);
    frame_ = 0;
    pictures_.fill(renderer::Texture(128, 80, 0xff808080u));
    const auto source = open(name, Side::left, 128, 80);
    play(*source, Side::left, 0, 1);
  }
}

}  // namespace
}  // namespace handcast::content
