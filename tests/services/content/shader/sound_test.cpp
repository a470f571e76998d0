// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/clock.hpp"
#include "tests/services/content/shader/shader_test.hpp"
#include "tests/services/content/sound/sound_devices.hpp"

namespace handcast::test {
namespace {

class ShaderSound : public ShaderTest {
 protected:
  /// Draws until the picture is of this colour, for 20 s at most.
  std::uint32_t await(const std::unique_ptr<Source>& source, std::uint32_t wanted) {
    for (const auto end = Deadline::in(std::chrono::seconds(20)); !end.passed();)
      if (colour(source) == wanted) return wanted;
    return colour(source);
  }

  SoundDevices devices_;
};

TEST_F(ShaderSound, IsfHearsSamplesAndBinsOfEachChannel) {
  opening_.sound = "tone";
  const auto source = isf(R"("INPUTS": [{"NAME": "wave", "TYPE": "audio"},
             {"NAME": "bands", "TYPE": "audioFFT", "MAX": 64}])",
                          R"(
float most(float row) {
  float most = 0.0;
  for (int i = 0; i < 200; ++i) most = max(most, IMG_PIXEL(wave, vec2(float(i) + 0.5, row)).r);
  return most;
}
bool is(float value, float wanted) { return abs(value - wanted) < 0.02; }
void main() {
  bool is_wave = is(most(0.5), 0.75) && is(most(1.5), 0.625) && IMG_SIZE(wave) == vec2(1024, 2);
  vec3 left = IMG_PIXEL(bands, vec2(44 / 16 + 0.5, 0.5)).rgb;
  bool is_bands = is(left.r, 0.5) && left.r == left.g && left.r == left.b;
  is_bands = is_bands && is(IMG_NORM_PIXEL(bands, vec2((128 / 16 + 0.5) / 64.0, 1.0)).r, 0.25);
  is_bands = is_bands && is(IMG_PIXEL(bands, vec2(30.5, 0.5)).r, 0.0);
  gl_FragColor = vec4(!(is_wave && is_bands), is_wave, is_bands && IMG_SIZE(bands) == vec2(64, 2), 1);
})");
  EXPECT_EQ(await(source, kBlue | kGreen), kBlue | kGreen);
  EXPECT_TRUE(is_new_);
}

TEST_F(ShaderSound, ShadertoyHearsDecibelsAndSamples) {
  opening_.sound = "tone";
  const auto source = toy(R"(//! iChannel1 = sound
void mainImage(out vec4 colour, in vec2 place) {
  bool is_loud = texture(iChannel1, vec2(44.5 / 512.0, 0.25)).x > 0.99;
  bool is_soft = texture(iChannel1, vec2(400.5 / 512.0, 0.25)).x < 0.3;
  bool moves = abs(texture(iChannel1, vec2(0.3, 0.75)).x - 0.5) > 0.01;
  colour = vec4(iChannelResolution[1].xy != vec2(512, 2), is_loud && is_soft, moves, 1);
})");
  EXPECT_EQ(await(source, kBlue | kGreen), kBlue | kGreen);
}

TEST_F(ShaderSound, SilenceIsGreyAndWithoutBins) {
  opening_.sound = "silence";
  const auto source = isf(R"("INPUTS": [{"NAME": "wave", "TYPE": "audio", "MAX": 16},
             {"NAME": "bands", "TYPE": "audioFFT"}])",
                          R"(void main() {
  bool is_grey = IMG_NORM_PIXEL(wave, vec2(0.1, 0.5)).r == 0.5 && IMG_SIZE(wave).x == 16.0;
  bool is_none = IMG_NORM_PIXEL(bands, vec2(0.1, 0.5)).r == 0.0 && IMG_SIZE(bands).x == 1024.0;
  gl_FragColor = vec4(1, !is_grey, !is_none, 1); })");
  EXPECT_EQ(colour(source), kRed);
}

}  // namespace
}  // namespace handcast::test
