// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "renderer/media/picture.hpp"
#include "services/content/shader/graphics.hpp"
#include "services/content/source.hpp"
#include "tests/scratch.hpp"

namespace handcast::test {

using namespace content;  // NOLINT(google-build-using-namespace)
using testing::HasSubstr;
using Texture = renderer::Texture;

/// A colour of a picture, RGBA8.
inline constexpr std::uint32_t kBlack = 0xff000000u, kRed = 0xff0000ffu, kGreen = 0xff00ff00u,
                               kBlue = 0xffff0000u, kWhite = 0xffffffffu;

/// Draws shader files with OpenGL. Skipped where there is none.
class ShaderTest : public testing::Test {
 protected:
  void SetUp() override {
    auto graphics = shader::Graphics::open();
    if (!graphics) GTEST_SKIP() << "no OpenGL here: " << graphics.error().what;
    graphics_ = std::move(*graphics);
    opening_.width = 8;
    opening_.height = 4;
  }

  std::string write(const std::string& name, const std::string& text) const {
    const auto file = scratch_.path() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file.string();
  }

  /// Opens "isf" or "shadertoy".
  Result<std::unique_ptr<Source>> opened(const std::string& kind, const std::string& name,
                                         const std::string& text) {
    opening_.element = {kind, write(name, text), {}};
    return open_source(opening_);
  }
  /// Opens an ISF file with a head ("" is an empty one) and a main().
  std::unique_ptr<Source> isf(const std::string& head, const std::string& body) {
    auto source = opened("isf", "it.fs", "/*{" + head + "}*/\n" + body);
    if (source) return std::move(*source);
    ADD_FAILURE() << source.error().what;
    return nullptr;
  }
  std::unique_ptr<Source> toy(const std::string& text) {
    auto source = opened("shadertoy", "it.frag", text);
    if (source) return std::move(*source);
    ADD_FAILURE() << source.error().what;
    return nullptr;
  }
  /// Why a file cannot be opened.
  std::string fault(const std::string& kind, const std::string& text) {
    const auto source = opened(kind, kind == "isf" ? "it.fs" : "it.frag", text);
    return source ? "" : source.error().what;
  }

  /// Draws the next picture.
  const Texture& draw(Source& source, const std::vector<Texture>& inputs = {}) {
    moment_.hand = &hand_;
    moment_.other = &other_;
    std::vector<renderer::View<const std::uint32_t>> views;
    views.reserve(inputs.size());
    for (const auto& input : inputs) views.push_back(input.view());
    if (picture_.width() == 0) picture_ = Texture(opening_.width, opening_.height);
    const auto drew = source.draw(moment_, views, picture_);
    EXPECT_TRUE(drew) << drew.error().what;
    is_new_ = drew && *drew;
    ++moment_.frame;
    moment_.time_s += moment_.step_s;
    return picture_;
  }
  /// The first texel of a picture that is of one colour.
  std::uint32_t colour(const std::unique_ptr<Source>& source,
                       const std::vector<Texture>& inputs = {}) {
    if (!source) return 0;
    const auto& drawn = draw(*source, inputs);
    for (const auto texel : drawn.pixels()) EXPECT_EQ(texel, drawn.at(0, 0));
    return drawn.at(0, 0);
  }

  std::shared_ptr<shader::Graphics> graphics_;
  Scratch scratch_;
  Opening opening_;
  Moment moment_;
  HandState hand_, other_;
  Texture picture_;
  bool is_new_ = false;
};

/// A level of a channel: 0 red, 1 green, 2 blue, 3 alpha.
inline int level(std::uint32_t texel, int channel) {
  return static_cast<int>(texel >> (8 * channel) & 255);
}

/// A picture whose texels count up: no two are alike.
inline Texture numbered(int width = 8, int height = 4) {
  Texture picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.at(x, y) =
          kBlack | static_cast<std::uint32_t>(20 * x) | static_cast<std::uint32_t>(50 * y) << 8;
  return picture;
}

}  // namespace handcast::test
