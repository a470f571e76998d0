// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "services/content/shader/shadertoy_text.hpp"
#include "tests/services/content/shader/shader_test.hpp"

namespace handcast::test {
namespace {

using Shadertoy = ShaderTest;

TEST_F(Shadertoy, AnImageWithItsTimeAndSize) {
  moment_.time_s = 0.2;
  moment_.step_s = 0.4;
  moment_.frame = 3;
  EXPECT_EQ(
      colour(toy("void mainImage(out vec4 fragColor, in vec2 fragCoord) {\n"
                 "  bool fits = iResolution == vec3(8.0, 4.0, 1.0) && iFrame == 3 && iFrameRate "
                 "== 2.5 && iSampleRate > 1.0;\n"
                 "  fragColor = vec4(iTime, iTimeDelta, fits ? 1.0 : 0.0, 0.0);\n}\n")),
      0xffff6633u)
      << "alpha does not matter";
}

TEST_F(Shadertoy, RowZeroIsTheTop) {
  const auto source =
      toy("void mainImage(out vec4 c, in vec2 p) { c = p.y > 2.0 ? vec4(1, 0, 0, 1) : "
          "vec4(0, p.x < 4.0, 0, 1); }");
  const auto& drawn = draw(*source);
  EXPECT_EQ(drawn.at(0, 0), kRed);
  EXPECT_EQ(drawn.at(0, 3), kGreen);
  EXPECT_EQ(drawn.at(7, 3), kBlack);
}

TEST_F(Shadertoy, TheDateCountsMonthsFromZero) {
  moment_.date.tm_year = 126;
  moment_.date.tm_mon = 10;
  moment_.date.tm_mday = 28;
  moment_.day_s = 60;
  EXPECT_EQ(
      colour(toy("void mainImage(out vec4 c, in vec2 p) { c = vec4(iDate == vec4(2026, 10, 28, "
                 "60)); }")),
      kWhite);
}

TEST_F(Shadertoy, TheMouseIsAParameter) {
  const auto source =
      toy("void mainImage(out vec4 c, in vec2 p) { c = iMouse.z > 0.0 ? "
          "vec4(iMouse.xy / iResolution.xy, 0, 1) : vec4(0, 0, 1, 1); }");
  EXPECT_EQ(colour(source), kBlue) << "nobody has touched it";
  draw(*source);
  EXPECT_FALSE(is_new_) << "it does not depend on the time";
  ASSERT_TRUE(source->set("mouse", "1,0.2"));
  EXPECT_EQ(colour(source), kBlack | 255u | 51u << 8);
}

TEST_F(Shadertoy, BuffersFeedEachOtherAndThemselves) {
  const auto source = toy(R"(
float half_of(float value) { return 0.5 * value; }
//! buffer A
void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + vec4(2.0); }
//! Buffer B
//! iChannel2 = buffer A nearest
void mainImage(out vec4 c, in vec2 p) { c = vec4(half_of(texelFetch(iChannel2, ivec2(p), 0).r)); }
//! image
//! iChannel0 = buffer B
void mainImage(out vec4 c, in vec2 p) { c = vec4(texelFetch(iChannel0, ivec2(p), 0).r / 5.0, 0, 0, 1); }
)");
  EXPECT_EQ(colour(source), kBlack | 51u) << "B sees the A of this picture, in floating point";
  EXPECT_EQ(colour(source), kBlack | 102u);
  EXPECT_EQ(colour(source), kBlack | 153u);
}

TEST_F(Shadertoy, ABufferSeesTheLastPictureOfOneBehindIt) {
  const auto source = toy(R"(
//! buffer A
void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel1, ivec2(p), 0); }
//! buffer B
void mainImage(out vec4 c, in vec2 p) { c = vec4(float(iFrame + 1) * 0.2, 0, 0, 1); }
//! image
void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }
)");
  EXPECT_EQ(colour(source), kBlack);
  EXPECT_EQ(colour(source), kBlack | 51u);
}

TEST_F(Shadertoy, PartsMayBeFilesOfTheirOwn) {
  write("it.common.frag", "#define RED vec4(1, 0, 0, 1)\n");
  write("it.b.frag", "void mainImage(out vec4 c, in vec2 p) { c = RED; }\n");
  EXPECT_EQ(
      colour(toy("void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel1, ivec2(p), "
                 "0) * RED; }")),
      kRed);
  EXPECT_THAT(fault("shadertoy",
                    "//! buffer B\nvoid mainImage(out vec4 c, in vec2 p) {}\n//! image\n"
                    "void mainImage(out vec4 c, in vec2 p) {}\n"),
              HasSubstr("it.frag:1: this part is in it.b.frag, too"));
}

TEST_F(Shadertoy, AFilterReadsItsInput) {
  const auto source =
      toy("//! iChannel1 = input\nvoid mainImage(out vec4 c, in vec2 p) { c = "
          "texture(iChannel1, p / iChannelResolution[1].xy); }");
  EXPECT_EQ(source->inputs(), 1);
  const auto below = numbered();
  EXPECT_EQ(draw(*source, {below}).pixels(), below.pixels());
}

TEST_F(Shadertoy, PicturesAreRepeatedUnlessItIsSaid) {
  auto two = Texture(2, 1, kRed);
  two.at(1, 0) = kBlue;
  ASSERT_TRUE(renderer::write_png(scratch_.path() / "my two.png", std::as_const(two).view()));
  const auto with = [&](const std::string& words) {
    return colour(toy("//! iChannel0 = my two.png nearest " + words +
                      "\nvoid mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, vec2(1.3, "
                      "0.5)); }"));
  };
  EXPECT_EQ(with(""), kRed);
  EXPECT_EQ(with("repeat"), kRed);
  EXPECT_EQ(with("clamp"), kBlue);
  EXPECT_EQ(with("mirror"), kBlue);
}

TEST_F(Shadertoy, WhatIsNotFiniteIsZero) {
  EXPECT_EQ(colour(toy("void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0 / (iTime * 0.0), "
                       "sqrt(-1.0 - iTime), 1, 1); }")),
            kBlue);
}

TEST_F(Shadertoy, AnErrorIsNamedWithTheLineOfItsFile) {
  EXPECT_THAT(fault("shadertoy", "void mainImage(out vec4 c, in vec2 p) {\n\n  c = oops;\n}\n"),
              HasSubstr("it.frag:3:"));
  const std::string whole =
      "//! common\nfloat f() { return 1.0; }\n//! buffer A\nvoid mainImage(out "
      "vec4 c, in vec2 p) {\n  c = vec4(1);\n}\n//! image\nvoid mainImage(out "
      "vec4 c, in vec2 p) {\n  c = vec4(f());\n}\n";
  const auto broken = [&](const std::string& what) {
    auto text = whole;
    text.replace(text.find(what), what.size(), "oops");
    return fault("shadertoy", text);
  };
  EXPECT_EQ(fault("shadertoy", whole), "");
  EXPECT_THAT(broken("return 1.0"), HasSubstr("it.frag:2:"));
  EXPECT_THAT(broken("vec4(1)"), HasSubstr("it.frag:5:"));
  EXPECT_THAT(broken("vec4(f())"), HasSubstr("it.frag:9:"));
  write("it.common.frag", "\n\noops;\n");
  EXPECT_THAT(fault("shadertoy", "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }"),
              HasSubstr("it.common.frag:3:"));
}

TEST_F(Shadertoy, WhatMakesNoSenseIsNamed) {
  const std::string image = "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }";
  EXPECT_THAT(fault("shadertoy", "void main() {}"),
              HasSubstr("it.frag: the image has no mainImage"));
  EXPECT_THAT(fault("shadertoy", "//! buffer A\n" + image), HasSubstr("it has no image"));
  EXPECT_THAT(fault("shadertoy", "//! buffer A\n//! image\n" + image),
              HasSubstr("the buffer A has no mainImage"));
  EXPECT_THAT(fault("shadertoy", "\n//! buffer E\n" + image), HasSubstr("it.frag:2: 'buffer E'"));
  EXPECT_THAT(fault("shadertoy", "//! iChannel0 = film.mp4\n" + image),
              HasSubstr("'film.mp4' is no channel"));
  EXPECT_THAT(fault("shadertoy", "//! iChannel7 = input\n" + image), HasSubstr("it.frag:1:"));
  EXPECT_THAT(fault("shadertoy", "//! iChannel0 = buffer B\n" + image), HasSubstr("the buffer B"));
  EXPECT_THAT(fault("shadertoy", "//! iChannel0 = gone.png\n" + image), HasSubstr("gone.png"));
  EXPECT_EQ(fault("shadertoy", "//! by me, in 2020\n" + image), "") << "a comment";
}

TEST_F(Shadertoy, AFileThatAppearsMakesItStale) {
  const auto source = toy("void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }");
  EXPECT_FALSE(source->is_stale());
  write("it.a.frag", "void mainImage(out vec4 c, in vec2 p) { c = vec4(1); }");
  EXPECT_TRUE(source->is_stale());
}

}  // namespace
}  // namespace handcast::test
