// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/gl_painter.hpp"

#include <EGL/egl.h>
#include <dlfcn.h>

#include "tests/renderer/draw/fill_contract.hpp"
#include "tests/renderer/draw/painter_contract.hpp"
#include "tests/renderer/draw/warp_contract.hpp"

namespace handcast::renderer::test {
namespace {

Result<std::unique_ptr<Painter>> open_gl(int width_px, int height_px) {
  return open_gl_painter(width_px, height_px);
}

INSTANTIATE_TEST_SUITE_P(gl, PainterContract, testing::Values(&open_gl),
                         [](const auto&) { return "without_window"; });

/// Opens a painter, or skips the test.
class GlPainterTest : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = open_gl_painter(200, 150, {.is_timed = true});
    if (!opened) GTEST_SKIP() << opened.error().what;
    painter_ = std::move(*opened);
  }

  static Shape square() {
    Shape shape;
    shape.rectangle({19.5f, 19.5f}, {119.5f, 99.5f});
    return shape;
  }

  std::unique_ptr<GlPainter> painter_;
};

TEST_F(GlPainterTest, NamesItsRendererAndSaysIfThatIsSoftware) {
  const gl::Gpu& gpu = painter_->gpu();
  EXPECT_FALSE(gpu.renderer.empty());
  EXPECT_EQ(gpu.is_software, gpu.renderer.find("llvmpipe") != std::string::npos) << gpu.renderer;
  EXPECT_NE(gpu.sentence().find(gpu.is_software ? "a software renderer" : "a hardware GPU"),
            std::string::npos);
}

TEST_F(GlPainterTest, MeasuresThePassesThatItDid) {
  const Shape shape = square();
  draw(*painter_, shape, {0, 0, 200, 150});
  const gl::PassTimes drawn = painter_->pass_times();
  EXPECT_GT(drawn[static_cast<int>(gl::Pass::draw)], 0);
  EXPECT_EQ(drawn[static_cast<int>(gl::Pass::fill)], 0);
  painter_->fill(mask_of(200, 150, {32, 25, 132, 105}).view(),
                 {.method = config::FillMethod::reflect}, {0, 0, 200, 150});
  EXPECT_GT(painter_->pass_times()[static_cast<int>(gl::Pass::fill)], 0);
  EXPECT_EQ(painter_->pass_times(), gl::PassTimes{}) << "times were given twice";
}

TEST_F(GlPainterTest, ACopyOfTheTextureIsUsedUntilItsRevisionChanges) {
  Shape shape(Texture(1, 1, 0xff112233)), other(Texture(1, 1, 0xff445566));
  for (Shape* each : {&shape, &other}) each->rectangle({10, 10}, {50, 50});
  const auto colour_of = [&](const Shape& each, std::uint64_t revision) {
    DrawnHand drawn = each.drawn();
    drawn.mesh_revision = drawn.picture_revision = revision;
    painter_->draw({&drawn, 1}, {0, 0, 200, 150});
    return painter_->colour().at(20, 20);
  };
  EXPECT_EQ(colour_of(shape, 7), 0xff112233u);
  EXPECT_EQ(colour_of(other, 7), 0xff112233u);
  EXPECT_EQ(colour_of(other, 8), 0xff445566u);
  EXPECT_EQ(colour_of(shape, 7), 0xff112233u);
  EXPECT_EQ(colour_of(shape, 0), 0xff112233u);
  EXPECT_EQ(colour_of(other, 0), 0xff445566u);
  for (std::uint64_t revision = 100; revision < 120; ++revision)  // more than it keeps
    EXPECT_EQ(colour_of(revision % 2 ? shape : other, revision),
              revision % 2 ? 0xff112233u : 0xff445566u);
}

TEST_F(GlPainterTest, TwoPaintersOnOneThreadDoNotDisturbEachOther) {
  auto other = *open_gl_painter(200, 150);
  const Shape shape = square();
  draw(*painter_, shape, {0, 0, 200, 150});
  draw(*other, shape, {0, 0, 60, 60});
  EXPECT_EQ(other->colour().at(100, 90), 0u);
  EXPECT_NE(painter_->colour().at(100, 90), 0u);
  other.reset();
  draw(*painter_, shape, {0, 0, 60, 60});
  EXPECT_NE(painter_->colour().at(100, 90), 0u);
  EXPECT_FALSE(painter_->failure());
}

TEST_F(GlPainterTest, ALostContextIsReportedAndDoesNoHarm) {
  const Shape shape = square();
  draw(*painter_, shape, {0, 0, 200, 150});
  ASSERT_FALSE(painter_->failure());

  void* const egl = dlopen("libEGL.so.1", RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(egl, nullptr);
  const auto function = [&]<class F>(F, const char* name) {
    return reinterpret_cast<F>(dlsym(egl, name));
  };
  const EGLDisplay display = function(PFNEGLGETCURRENTDISPLAYPROC{}, "eglGetCurrentDisplay")();
  const EGLContext context = function(PFNEGLGETCURRENTCONTEXTPROC{}, "eglGetCurrentContext")();
  function(PFNEGLMAKECURRENTPROC{}, "eglMakeCurrent")(display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                                                      EGL_NO_CONTEXT);
  ASSERT_TRUE(function(PFNEGLDESTROYCONTEXTPROC{}, "eglDestroyContext")(display, context));

  draw(*painter_, shape, {0, 0, 200, 150});
  painter_->fill(mask_of(200, 150, {32, 25, 132, 105}).view(),
                 {.method = config::FillMethod::reflect}, {0, 0, 200, 150});
  painter_->colour();
  const auto failure = painter_->failure();
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code, Errc::unavailable);
  EXPECT_NE(failure->what.find(painter_->gpu().renderer), std::string::npos) << failure->what;
  EXPECT_NE(failure->what.find("EGL_BAD"), std::string::npos) << failure->what;
}

}  // namespace
}  // namespace handcast::renderer::test
