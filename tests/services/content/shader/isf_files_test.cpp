// SPDX-License-Identifier: Apache-2.0
// What the files do that people exchange: old versions of ISF and GLSL, and odd habits.
#include <gmock/gmock.h>

#include "tests/services/content/shader/shader_test.hpp"

namespace handcast::test {
namespace {

using IsfFiles = ShaderTest;

constexpr const char* kFilter = R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}])";

TEST_F(IsfFiles, PrecisionForOtherMachines) {
  EXPECT_EQ(colour(isf("", R"(
#ifdef GL_ES
precision highp float;
#endif
varying mediump vec2 nothing;
void main(void) { highp vec4 c = vec4(1.0, 0.0, 0.0, 1.0); gl_FragColor = c; })")),
            kRed);
  EXPECT_EQ(
      colour(isf("", "precision mediump float;\nvoid main() { gl_FragColor = vec4(1, 0, 0, 1); }")),
      kRed);
}

TEST_F(IsfFiles, Version1KeepsItsBuffers) {
  for (const auto* buffers : {R"(["last"])", R"({"last": {"WIDTH": "$WIDTH", "HEIGHT": 4}})"}) {
    const auto source = isf(std::string(R"("DESCRIPTION": "no ISFVSN", "PERSISTENT_BUFFERS": )") +
                                buffers + R"(, "PASSES": [{"TARGET": "last"}, {}])",
                            R"(void main() { if (PASSINDEX == 0) gl_FragColor = vec4(0.2, 0, 0, 1) +
               IMG_PIXEL(last, gl_FragCoord.xy); else gl_FragColor = IMG_THIS_PIXEL(last); })");
    EXPECT_EQ(colour(source), kBlack | 51u);
    EXPECT_EQ(colour(source), kBlack | 102u) << buffers;
  }
}

TEST_F(IsfFiles, ThePictureOfVersion1IsABufferItself) {
  const auto source =
      isf(R"("PERSISTENT_BUFFERS": ["last"], "PASSES": [{"TARGET": "last"}])",
          "void main() { gl_FragColor = IMG_THIS_PIXEL(last) + vec4(0.2, 0, 0, 1); }");
  colour(source);
  EXPECT_EQ(colour(source), kBlack | 102u);
}

TEST_F(IsfFiles, APassWithoutATargetInTheMiddle) {
  EXPECT_EQ(colour(isf(R"("PASSES": [{}, {"TARGET": "a"}, {}])", R"(void main() {
    if (PASSINDEX == 0) gl_FragColor = vec4(0, 0, 1, 1);
    else if (PASSINDEX == 1) gl_FragColor = vec4(1, 0, 0, 1);
    else gl_FragColor = IMG_THIS_NORM_PIXEL(a); })")),
            kRed);
}

TEST_F(IsfFiles, ATargetThatIsAnInput) {
  const auto source =
      isf(R"("INPUTS": [{"NAME": "inputImage", "TYPE": "image"}, {"NAME": "soft", "TYPE": "image"}],
             "PASSES": [{"TARGET": "soft"}, {}])",
          R"(void main() { gl_FragColor = PASSINDEX == 0 ? IMG_THIS_PIXEL(inputImage).bgra
                                                         : IMG_THIS_PIXEL(soft); })");
  EXPECT_EQ(colour(source, {Texture(8, 4, kRed)}), kBlue);
}

TEST_F(IsfFiles, VertexShadersGiveLists) {
  write("it.vs", R"(
varying vec2 around[9];
varying vec2 left_coord;
void main() {
  vv_vertShaderInit();
  vec2 step = 1.0 / RENDERSIZE.xy;
  vec2 offsets[3] = vec2[3](vec2(0.0), vec2(step.x, 0.0), vec2(0.0, step.y));
  for (int i = 0; i < 9; ++i) around[i] = vv_FragNormCoord + offsets[i / 3];
  left_coord = clamp(vec2(vv_FragNormCoord.xy + vec2(-step.x, 0.0)), 0.0, 1.0);
})");
  const auto source = isf(kFilter, R"(
varying vec2 around[9];
varying vec2 left_coord;
void main() { gl_FragColor = IMG_NORM_PIXEL(inputImage, around[4]); })");
  const auto& drawn = draw(*source, {numbered()});
  EXPECT_EQ(drawn.at(2, 1), numbered().at(3, 1)) << "the texel to the right";
}

TEST_F(IsfFiles, TheVaryingsOfAMissingVertexShaderAreZero) {
  EXPECT_NE(colour(isf("",
                       "varying vec2 nothing;\nvoid main() { gl_FragColor = vec4(1, nothing.x * "
                       "0.0, 0, 1); }")),
            0u);
}

TEST_F(IsfFiles, AllWaysToReadAPixel) {
  const auto below = numbered();
  for (const auto* way :
       {"IMG_THIS_PIXEL(inputImage)", "IMG_THIS_NORM_PIXEL(inputImage)",
        "IMG_PIXEL(inputImage, gl_FragCoord.xy)",
        "IMG_PIXEL(inputImage, gl_FragCoord.xy + vec2(0))",
        "IMG_NORM_PIXEL(inputImage, isf_FragNormCoord)",
        "IMG_NORM_PIXEL(inputImage, vv_FragNormCoord.xy)",
        "IMG_NORM_PIXEL(inputImage, gl_FragCoord.xy / RENDERSIZE)",
        "texture2D(inputImage, isf_FragNormCoord)", "texture2D(inputImage, isf_FragNormCoord, 0.0)",
        "texture(inputImage, isf_FragNormCoord)", "texture2DRect(inputImage, gl_FragCoord.xy)",
        "IMG_PIXEL(inputImage, isf_FragNormCoord * IMG_SIZE(inputImage))",
        "IMG_PIXEL(inputImage, isf_FragNormCoord * _inputImage_imgSize)",
        "IMG_NORM_PIXEL(inputImage, isf_FragNormCoord * _inputImage_imgRect.zw)",
        "texelFetch(inputImage, ivec2(gl_FragCoord.xy), 0)"}) {
    const auto source = isf(kFilter, std::string("void main() { gl_FragColor = ") + way + "; }");
    ASSERT_TRUE(source) << way;
    EXPECT_EQ(draw(*source, {below}).pixels(), below.pixels()) << way;
  }
}

TEST_F(IsfFiles, ImagesAreGivenToFunctions) {
  const auto source = isf(kFilter, R"(
vec4 soft(sampler2D image, vec2 at) { return texture2D(image, at); }
vec4 hard(sampler2DRect image, vec2 at) { return texture2DRect(image, at); }
void main() { gl_FragColor = 0.5 * soft(inputImage, isf_FragNormCoord) +
                             0.5 * hard(inputImage, gl_FragCoord.xy); })");
  EXPECT_EQ(colour(source, {Texture(8, 4, kRed)}), kRed);
}

TEST_F(IsfFiles, SwitchesOverThePass) {
  EXPECT_EQ(colour(isf(R"("PASSES": [{"TARGET": "a"}, {}])", R"(void main() {
    switch (PASSINDEX) {
      case 0: gl_FragColor = vec4(0, 1, 0, 1); break;
      default: gl_FragColor = IMG_THIS_PIXEL(a);
    } })")),
            kGreen);
}

TEST_F(IsfFiles, InputsBoundLoops) {
  const auto source = isf(R"("INPUTS": [{"NAME": "steps", "TYPE": "long", "MIN": 1, "MAX": 5,
      "DEFAULT": 2}, {"NAME": "amount", "TYPE": "float", "MAX": 10, "DEFAULT": 3}])",
                          R"(void main() {
    float sum = 0;
    for (int i = 0; i < steps; ++i) sum += 0.2;
    for (float i = 0.0; i < amount; i++) sum += 0.2;
    gl_FragColor = vec4(sum, 0, 0, 1); })");
  EXPECT_EQ(colour(source), kRed);
}

TEST_F(IsfFiles, NamesThatGlslHasTaken) {
  const auto head = [](const std::string& name) {
    return R"("INPUTS": [{"NAME": ")" + name + R"(", "TYPE": "float", "DEFAULT": 1}])";
  };
  for (const auto* name :
       {"sample", "input", "filter", "output", "noise", "texture", "smooth", "active", "half",
        "flat", "buffer", "common", "shared", "invert", "scale"}) {
    const auto source =
        isf(head(name), std::string("void main() { gl_FragColor = vec4(") + name + ", 0, 0, 1); }");
    EXPECT_EQ(colour(source), kRed) << name;
  }
  EXPECT_EQ(colour(isf("",
                       "float noise(float filter) { return filter; } void main() { float sample = "
                       "noise(1.0), input = 0.0; gl_FragColor = vec4(sample, input, 0, 1); }")),
            kRed);
}

TEST_F(IsfFiles, AnInputThatIsNamedLikeAFunction) {
  const auto source = isf(R"("INPUTS": [{"NAME": "mix", "TYPE": "float", "DEFAULT": 1},
                        {"NAME": "radius", "TYPE": "float", "DEFAULT": 0},
                        {"NAME": "distance", "TYPE": "float", "DEFAULT": 0}])",
                          "void main() { gl_FragColor = vec4(mix, radius, distance, 1); }");
  EXPECT_EQ(colour(source), kRed);
}

TEST_F(IsfFiles, WholeNumbersWhereOthersAreMeant) {
  EXPECT_EQ(colour(isf(R"("INPUTS": [{"NAME": "n", "TYPE": "long", "DEFAULT": 1, "MAX": 3}])", R"(
const float kSteps = 4;
const vec3 kPalette[2] = vec3[](vec3(1, 0, 0), vec3(0, 1, 0));
float late(float value);
void main() {
  float a = 1 / kSteps + n * 0.75;
  if (a > 0) a *= 2 - 1;
  vec3 c = kPalette[n - 1] * late(a);
  gl_FragColor = vec4(c, 1);
}
float late(float value) { return clamp(value, 0, 1); })")),
            kRed);
}

TEST_F(IsfFiles, FunctionsThatAreDefinedBehindTheirUse) {
  const auto source = opened("isf", "late.fs",
                             "/*{}*/\nvoid main() { gl_FragColor = late(); }\nvec4 late() { return "
                             "vec4(1, 0, 0, 1); }\n");
  EXPECT_FALSE(source) << "GLSL has no such thing, nor has any other program";
}

TEST_F(IsfFiles, LineEndsAndSignsOfOtherSystems) {
  const auto source =
      opened("isf", "windows.fs",
             "\xef\xbb\xbf/*{\r\n\t\"CREDIT\": \"Zo\xc3\xab \xe2\x80\x94 \xff\",\r\n"
             "\t\"INPUTS\": [\r\n\t]\r\n}*/\r\n// na\xc3\xafve\r\nvoid main() {\r\n"
             "\tgl_FragColor = vec4(1, 0, 0, 1); // \xe2\x9c\x93\r\n}\r\n");
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ(colour(*source), kRed);
  const auto macintosh = opened("isf", "old.fs",
                                "/*{\r\"CREDIT\": \"x\"\r}*/\r// x\rvoid main() {\rgl_FragColor = "
                                "vec4(1, 0, 0, 1);\r}\r");
  ASSERT_TRUE(macintosh) << macintosh.error().what;
  EXPECT_EQ(colour(*macintosh), kRed);
  EXPECT_THAT(fault("isf", "/*{\r\n}*/\r\nvoid main() {\r\n  oops;\r\n}"), HasSubstr("it.fs:4:"));
}

TEST_F(IsfFiles, TextsBeforeTheHeadAndSlopInIt) {
  const auto source = opened("isf", "sloppy.fs", R"(// Saved by somebody
/* under some licence */
/*
{
  "DESCRIPTION": "two
lines", // and a comment
  "INPUTS": [ {"NAME": "a", "TYPE": "float", "DEFAULT": 1., "MIN": .0, "MAX": 1.0,}, ],
}
*/
void main() { gl_FragColor = vec4(a, 0, 0, 1); })");
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ(colour(*source), kRed);
}

TEST_F(IsfFiles, MacrosAndOutputsOfEachVersion) {
  EXPECT_EQ(colour(isf("",
                       "#version 120\n#extension GL_ARB_gpu_shader5 : enable\n#define RED vec4(1, "
                       "0, 0, 1)\nvoid main() { gl_FragColor = RED; }")),
            kRed);
  EXPECT_EQ(colour(isf("", "out vec4 result;\nvoid main() { result = vec4(1, 0, 0, 1); }")), kRed);
  EXPECT_EQ(colour(isf("", "void main() { gl_FragData[0] = vec4(1, 0, 0, 1); }")), kRed);
  EXPECT_EQ(colour(isf("",
                       "void paint(out vec4 c) { c = vec4(1, 0, 0, 1); } void main() { vec4 d; "
                       "paint(d); gl_FragColor = d; }")),
            kRed);
  EXPECT_EQ(colour(isf("",
                       "void main() { gl_FragColor = vec4(1, 0, 0, 1); if (isf_FragNormCoord.x >= "
                       "0.0) return; gl_FragColor = vec4(0); }")),
            kRed);
}

TEST_F(IsfFiles, LaterAndLaxerGlsl) {
  for (const auto* body :
       {"float a[2] = {1.0, 0.0}; gl_FragColor = vec4(a[0], 0, 0, 1);",
        "const float t = TIME + 1.0; gl_FragColor = vec4(t, 0, 0, 1);",
        "int k = 1; vec2 v = vec2(1, 0) * k; gl_FragColor = vec4(v, k - 1, k);",
        "float c = 1.; bool b = bool(k); gl_FragColor = vec4(b ? c : 0., FRAMEINDEX & 0, 0, 1);"})
    EXPECT_EQ(colour(isf("", std::string("int k = 1;\nfloat round(float x) { return x; }\n"
                                         "float twice = TIME * 2.0;\nvoid main() { ") +
                                 body + " }")),
              kRed)
        << body;
}

TEST_F(IsfFiles, WhatIsDiscardedIsTransparent) {
  EXPECT_EQ(colour(isf("", "void main() { discard; }")), 0u);
}

TEST_F(IsfFiles, ASizeOfZeroOrOfNothingIsOnePixel) {
  for (const auto* width : {"0", "\"$WIDTH / 0\"", "-5", "\"0.0 / 0.0\"", "\"$WIDTH * 0.001\""})
    EXPECT_EQ(
        colour(isf(std::string(R"("PASSES": [{"TARGET": "a", "WIDTH": )") + width + "}, {}]",
                   "void main() { gl_FragColor = PASSINDEX == 0 ? vec4(RENDERSIZE.x, 0, 0, 1) "
                   ": IMG_THIS_PIXEL(a); }")),
        kRed)
        << width;
}

}  // namespace
}  // namespace handcast::test
