// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <chrono>

#include "tests/services/content/shader/shader_test.hpp"

namespace handcast::test {
namespace {

using Isf = ShaderTest;

TEST_F(Isf, RowZeroIsTheTop) {
  const auto source = isf("",
                          "void main() { gl_FragColor = isf_FragNormCoord.y > 0.5 ? vec4(1, 0, "
                          "0, 1) : vec4(0, 0, isf_FragNormCoord.x < 0.5, 1); }");
  const auto& drawn = draw(*source);
  EXPECT_EQ(drawn.at(0, 0), kRed);
  EXPECT_EQ(drawn.at(7, 1), kRed);
  EXPECT_EQ(drawn.at(0, 3), kBlue);
  EXPECT_EQ(drawn.at(7, 3), kBlack);
}

TEST_F(Isf, PicturesArePremultiplied) {
  EXPECT_EQ(colour(isf("", "void main() { gl_FragColor = vec4(1.0, 0.5, 0.25, 0.5); }")),
            0x80204080u);
}

TEST_F(Isf, WhatIsNotFiniteIsZero) {
  EXPECT_EQ(colour(isf(R"("INPUTS": [{"NAME": "zero", "TYPE": "float", "DEFAULT": 0}])",
                       "void main() { gl_FragColor = vec4(1.0 / zero, zero / zero, sqrt(-1.0 - "
                       "zero), 1.0); }")),
            kBlack);
}

TEST_F(Isf, EachTypeOfInputArrives) {
  const auto source = isf(
      R"("INPUTS": [{"NAME": "hit", "TYPE": "event"}, {"NAME": "on", "TYPE": "bool"},
         {"NAME": "mode", "TYPE": "long", "VALUES": [3, 5], "LABELS": ["three", "five"]},
         {"NAME": "part", "TYPE": "float"}, {"NAME": "place", "TYPE": "point2D"},
         {"NAME": "spot", "TYPE": "point2D", "MIN": [0, 0], "MAX": [1, 1]},
         {"NAME": "tint", "TYPE": "color", "DEFAULT": [0, 0, 1, 1]},
         {"NAME": "which", "TYPE": "long", "MIN": 0, "MAX": 9}])",
      R"(void main() {
        vec4 c = vec4(0, 0, 0, 1);
        if (which == 0) c.r = float(hit);
        if (which == 1) c.r = on ? 1.0 : 0.0;
        if (which == 2) c.r = mode == 5 ? 1.0 : 0.0;
        if (which == 3) c.r = part;
        if (which == 4) c.rg = place / RENDERSIZE;
        if (which == 5) c.rg = spot;
        if (which == 6) c = tint;
        gl_FragColor = c;
      })");
  const auto with = [&](const char* which, const char* name, const char* value) {
    EXPECT_TRUE(source->set("which", which));
    EXPECT_TRUE(source->set(name, value)) << name;
    return colour(source);
  };
  EXPECT_EQ(with("0", "hit", "true"), kRed);
  EXPECT_EQ(colour(source), kBlack) << "an event is seen once";
  EXPECT_EQ(with("1", "on", "true"), kRed);
  EXPECT_EQ(with("2", "mode", "five"), kRed);
  EXPECT_EQ(with("3", "part", "0.2"), kBlack | 51u);
  EXPECT_EQ(with("4", "place", "1,0.2"), kRed | 51u << 8) << "in pixels";
  EXPECT_EQ(with("5", "spot", "0.2,1"), kGreen | 51u) << "as it is";
  EXPECT_EQ(with("6", "tint", "#00ff00"), kGreen);
  EXPECT_FALSE(source->set("part", "2")) << "out of its range";
}

TEST_F(Isf, TimesAndDatesArrive) {
  moment_.time_s = 0.2;
  moment_.step_s = 0.4;
  moment_.frame = 3;
  moment_.date.tm_year = 126;
  moment_.date.tm_mon = 10;
  moment_.date.tm_mday = 28;
  moment_.day_s = 3600;
  const auto source = isf("", R"(void main() {
    bool is_date = DATE == vec4(2026.0, 11.0, 28.0, 3600.0);
    gl_FragColor = vec4(TIME, TIMEDELTA, float(FRAMEINDEX) / 5.0, is_date ? 1.0 : 0.0); })");
  EXPECT_EQ(colour(source), 0xff996633u);
}

TEST_F(Isf, ADrawingWithoutTimeIsDrawnOnce) {
  const auto source = isf(R"("INPUTS": [{"NAME": "a", "TYPE": "float"}])",
                          "void main() { gl_FragColor = vec4(a, 0, 0, 1); }");
  draw(*source);
  EXPECT_TRUE(is_new_);
  draw(*source);
  EXPECT_FALSE(is_new_);
  ASSERT_TRUE(source->set("a", "1"));
  EXPECT_EQ(colour(source), kRed);
  EXPECT_TRUE(is_new_);
}

TEST_F(Isf, AFilterIsGivenThePictureBelow) {
  const auto source = isf(R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}])",
                          "void main() { gl_FragColor = IMG_THIS_PIXEL(inputImage); }");
  EXPECT_EQ(source->inputs(), 1);
  EXPECT_TRUE(source->parameters().empty()) << "the input is not set by a person";
  const auto below = numbered();
  EXPECT_EQ(draw(*source, {below}).pixels(), below.pixels());
}

TEST_F(Isf, HalfTransparentPicturesPassThroughAFilter) {
  const auto source = isf(R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}])",
                          "void main() { vec4 c = IMG_THIS_PIXEL(inputImage); gl_FragColor = c; }");
  EXPECT_EQ(colour(source, {Texture(8, 4, 0x80402000u)}), 0x80402000u);
  EXPECT_EQ(colour(source, {Texture(8, 4, 0x00000000u)}), 0u);
}

TEST_F(Isf, ATransitionMixesTwoPicturesByItsProgress) {
  const auto source = isf(
      R"("INPUTS": [{"NAME": "startImage", "TYPE": "image"}, {"NAME": "endImage", "TYPE": "image"},
         {"NAME": "progress", "TYPE": "float"}, {"NAME": "soft", "TYPE": "float"}])",
      "void main() { gl_FragColor = mix(IMG_THIS_PIXEL(startImage), IMG_THIS_PIXEL(endImage), "
      "progress); }");
  EXPECT_EQ(source->inputs(), 2);
  ASSERT_EQ(source->parameters().size(), 1u);
  EXPECT_EQ(source->parameters()[0].name, "soft");
  const std::vector<Texture> both{Texture(8, 4, kRed), Texture(8, 4, kBlue)};
  EXPECT_EQ(colour(source, both), kRed);
  moment_.progress = 1;
  EXPECT_EQ(colour(source, both), kBlue);
  moment_.progress = 0.2;
  EXPECT_EQ(colour(source, both), 0xff3300ccu);
}

TEST_F(Isf, PassesHaveTheirOwnSizes) {
  const auto source = isf(R"("INPUTS": [{"NAME": "n", "TYPE": "float", "MIN": 1, "MAX": 9}],
      "PASSES": [{"TARGET": "a", "WIDTH": "$WIDTH * $n", "HEIGHT": "3"}, {}])",
                          R"(void main() {
    if (PASSINDEX == 0) gl_FragColor = vec4(RENDERSIZE / 255.0, 0, 1);
    else gl_FragColor = IMG_SIZE(a) == floor(255.0 * IMG_NORM_PIXEL(a, vec2(0.5)).rg + 0.5)
                            ? IMG_NORM_PIXEL(a, vec2(0.5)) : vec4(1); })");
  EXPECT_EQ(colour(source), kBlack | 8u | 3u << 8);
  ASSERT_TRUE(source->set("n", "5"));
  EXPECT_EQ(colour(source), kBlack | 40u | 3u << 8);
}

TEST_F(Isf, PersistentPassesKeepTheirPicture) {
  const auto source =
      isf(R"("PASSES": [{"TARGET": "last", "PERSISTENT": true}, {}])", R"(void main() {
    gl_FragColor = PASSINDEX == 0 ? IMG_THIS_PIXEL(last) + vec4(0.2, 0, 0, 1) : IMG_THIS_PIXEL(last);
  })");
  EXPECT_EQ(colour(source), kBlack | 51u);
  EXPECT_EQ(colour(source), kBlack | 102u);
  EXPECT_EQ(colour(source), kBlack | 153u);
}

TEST_F(Isf, FloatPassesKeepWhatBytesCannot) {
  for (const bool is_float : {true, false}) {
    const auto source = isf(std::string(R"("PASSES": [{"TARGET": "a", "FLOAT": )") +
                                (is_float ? "true" : "false") + "}, {}]",
                            "void main() { gl_FragColor = PASSINDEX == 0 ? vec4(1000.0, -3.0, "
                            "0.0, 1.0) : IMG_THIS_PIXEL(a) * vec4(0.001, -0.2, 1, 1); }");
    EXPECT_EQ(colour(source), is_float ? kBlack | 255u | 153u << 8 : kBlack);
  }
}

TEST_F(Isf, ThePictureOfTheLastPassIsShownWhateverItsSizeAndName) {
  const auto source = isf(R"("PASSES": [{"TARGET": "a", "WIDTH": 2, "HEIGHT": 2}])",
                          "void main() { gl_FragColor = vec4(1, 0, 0, 1); }");
  EXPECT_EQ(colour(source), kRed);
}

TEST_F(Isf, AVertexShaderMovesThePicture) {
  write("it.vs",
        "out vec2 shifted;\nvoid main() { isf_vertShaderInit(); shifted = "
        "isf_FragNormCoord + vec2(0.5, 0); gl_Position.x *= 0.5; }");
  const auto source = isf("",
                          "in vec2 shifted;\nvoid main() { gl_FragColor = vec4(shifted.x > 1.0, "
                          "0, 0, 1); }");
  const auto& drawn = draw(*source);
  EXPECT_EQ(drawn.at(0, 0), 0u) << "nothing is drawn beside it";
  EXPECT_EQ(drawn.at(2, 0), kBlack);
  EXPECT_EQ(drawn.at(5, 0), kRed);
}

TEST_F(Isf, ImagesComeFromImportsAndFromParameters) {
  ASSERT_TRUE(renderer::write_png(scratch_.path() / "red.png", Texture(2, 2, kRed).view()));
  ASSERT_TRUE(renderer::write_png(scratch_.path() / "blue.png", Texture(2, 2, kBlue).view()));
  const auto source =
      isf(R"("IMPORTED": {"logo": {"PATH": "red.png"}},
      "INPUTS": [{"NAME": "other", "TYPE": "image"}])",
          "void main() { gl_FragColor = IMG_THIS_PIXEL(logo) + IMG_THIS_PIXEL(other); }");
  EXPECT_EQ(colour(source), kRed) << "an image that is not set is transparent";
  ASSERT_TRUE(source->set("other", (scratch_.path() / "blue.png").string()));
  EXPECT_EQ(colour(source), 0xffff00ffu);
  const auto refused = source->set("other", "nowhere.png");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("nowhere.png"));
  const auto without = isf(R"("IMPORTED": {"logo": {"PATH": "gone.png"}})",
                           "void main() { gl_FragColor = IMG_THIS_PIXEL(logo); }");
  EXPECT_EQ(colour(without), 0u) << "a picture that is missing is a warning";
}

TEST_F(Isf, AnErrorIsNamedWithItsLine) {
  EXPECT_THAT(fault("isf", "/*{\n}*/\n\nvoid main() {\n  gl_FragColor = vec4(nothing);\n}\n"),
              testing::AllOf(HasSubstr("it.fs:5:"), HasSubstr("nothing"),
                             HasSubstr("gl_FragColor = vec4(nothing);")));
  EXPECT_THAT(
      fault("isf", "/*{}*/ /* two\nlines */\n#version 120\nvoid main() {\n  sample(1);\n}"),
      testing::AllOf(HasSubstr("it.fs:5:"), HasSubstr("sample"), testing::Not(HasSubstr("hc_"))));
  EXPECT_THAT(fault("isf", "/*{\n}*/\nvoid main() {\n  gl_FragColor = vec4(1);\n"),
              HasSubstr("it.fs:"));
  write("it.vs", "\nvoid main() {\n  isf_vertShaderInit();\n  oops;\n}\n");
  EXPECT_THAT(fault("isf", "/*{}*/ void main() { gl_FragColor = vec4(1); }"),
              HasSubstr("it.vs:4:"));
}

TEST_F(Isf, FilesThatAreNoneAreNamed) {
  EXPECT_THAT(fault("isf", "hello"), HasSubstr("it.fs: it is no ISF file"));
  EXPECT_THAT(fault("isf", "/*{}*/ void helper() {}"), HasSubstr("main"));
  opening_.element = {"isf", (scratch_.path() / "gone.fs").string(), {}};
  const auto gone = open_source(opening_);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Errc::bad_config);
  EXPECT_THAT(gone.error().what, HasSubstr("gone.fs"));
}

TEST_F(Isf, AFileThatChangesIsStale) {
  namespace fs = std::filesystem;
  const auto source = isf("", "void main() { gl_FragColor = vec4(1); }");
  EXPECT_FALSE(source->is_stale());
  const auto vertex = write("it.vs", "void main() { isf_vertShaderInit(); }");
  EXPECT_TRUE(source->is_stale()) << "a vertex shader has appeared";
  fs::remove(vertex);
  EXPECT_FALSE(source->is_stale());
  const auto file = scratch_.path() / "it.fs";
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(3));
  EXPECT_TRUE(source->is_stale());
}

TEST_F(Isf, SourcesDoNotDisturbEachOther) {
  const auto red = isf("", "void main() { gl_FragColor = vec4(1, 0, 0, fract(TIME) + 1.0); }");
  const auto feedback =
      isf(R"("PASSES": [{"TARGET": "a", "PERSISTENT": true, "WIDTH": 3, "HEIGHT": 3}, {}])",
          "void main() { gl_FragColor = PASSINDEX == 0 ? IMG_THIS_PIXEL(a) + vec4(0, 0, 0.2, 1) : "
          "IMG_THIS_PIXEL(a); }");
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(colour(red), kRed);
    EXPECT_EQ(colour(feedback), kBlack | static_cast<std::uint32_t>(51 * i) << 16);
  }
}

}  // namespace
}  // namespace handcast::test
