// SPDX-License-Identifier: Apache-2.0
// The painter gl beside the painter cpu, after each pass, on hands from all built-in motions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "renderer/content/textures.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/draw/gl/gl_painter.hpp"
#include "renderer/skin/hand_surface.hpp"
#include "services/lab/twin/motion.hpp"
#include "tests/renderer/draw/bent_grid.hpp"
#include "tests/renderer/draw/gl/difference.hpp"
#include "tests/renderer/hand_pose.hpp"

namespace handcast::renderer::test {
namespace {

std::vector<std::string> motion_names() {
  std::vector<std::string> names;
  std::istringstream list(twin::builtin_motion_names());
  for (std::string name; std::getline(list >> std::ws, name, ',');) names.push_back(name);
  return names;
}

/// One hand of the scene, skinned for one frame.
struct Hand {
  explicit Hand(Side which)
      : side(which),
        surface(*load_hand_or_default({}, which), 14),
        texture(*load_content("builtin:atlas", surface.mesh()), true) {}

  Side side;
  HandSurface surface;
  MipChain texture;
  std::uint64_t revision = new_revision();
  Skinned skinned;

  DrawnHand drawn() const {
    return {&surface.mesh(), texture.view(), skinned.projected_px, skinned.depth_m, skinned.light,
            revision,        revision};
  }
};

/// The light of a drawing, moved, with shares of pixels at its edges.
Image<std::uint8_t> moved_silhouette(View<const SurfaceId> surface, int dx, int dy) {
  Image<std::uint8_t> mask(surface.width, surface.height);
  for (int y = std::max(dy, 0); y < std::min(surface.height, surface.height + dy); ++y)
    for (int x = std::max(dx, 0); x < std::min(surface.width, surface.width + dx); ++x)
      mask.at(x, y) = surface.at(x - dx, y - dy) ? 255 : 0;
  Image<std::uint8_t> soft = mask;
  for (int y = 1; y + 1 < mask.height(); ++y)
    for (int x = 1; x + 1 < mask.width(); ++x)
      soft.at(x, y) =
          static_cast<std::uint8_t>((4 * mask.at(x, y) + mask.at(x - 1, y) + mask.at(x + 1, y) +
                                     mask.at(x, y - 1) + mask.at(x, y + 1)) /
                                    8);
  return soft;
}

/// What a pass may differ by. Where a pixel lies on an edge, or its source between two pixels, both
/// results are right, and such pixels are few.
struct Bounds {
  double surface_share;            ///< of the lit pixels
  double uv_mean, uv_p99, uv_max;  ///< a texel is 0.001
  double colour_mean, colour_p99;  ///< a neighbouring texel may have any colour
};

void expect_within(const Bounds& bounds, const Difference& difference) {
  EXPECT_LE(difference.surface_share(), bounds.surface_share);
  EXPECT_LE(difference.uv.mean(), bounds.uv_mean);
  EXPECT_LE(difference.uv.p99(), bounds.uv_p99);
  EXPECT_LE(difference.uv.max(), bounds.uv_max);
  EXPECT_LE(difference.colour.mean(), bounds.colour_mean);
  EXPECT_LE(difference.colour.p99(), bounds.colour_p99);
}

class Parity : public testing::TestWithParam<std::string> {
 protected:
  static constexpr Rect kScreen{0, 0, 1024, 768};

  static void SetUpTestSuite() {
    auto opened = open_gl_painter(kScreen.x1, kScreen.y1);
    if (opened) {
      gl_ = std::move(*opened);
      cpu_ = make_cpu_painter(kScreen.x1, kScreen.y1);
    } else {
      reason_ = opened.error().what;
    }
  }
  static void TearDownTestSuite() {
    gl_.reset();
    cpu_.reset();
  }
  void SetUp() override {
    if (!gl_) GTEST_SKIP() << reason_;
  }

  /// Skins the hands that the motion has at a time. Returns the region around them.
  Rect pose_hands(const twin::Motion& motion, double seconds) {
    drawn_.clear();
    Rect region;
    for (Hand& hand : hands_) {
      const auto frames = motion.at(hand.side, seconds);
      if (!frames) continue;
      hand.skinned =
          hand.surface.pose(pose_of(hand.side, *frames), {.fit = false}, calibration_, 0.6f);
      drawn_.push_back(hand.drawn());
      region = region.joined(hand.surface.bounds(hand.skinned.projected_px));
    }
    return region.grown(24).within(kScreen.x1, kScreen.y1);
  }

  void compare_passes(const Rect& region) {
    gl_->draw(drawn_, region);
    cpu_->draw(drawn_, region);
    draw_.add(*cpu_, *gl_, region);

    const WarpGrid grid = bent_grid(kScreen);
    gl_->warp(grid, region, region);
    cpu_->warp(grid, region, region);
    warp_.add(*cpu_, *gl_, region);

    // Both fill the same drawing, without the differences of the warp.
    gl_->draw(drawn_, region);
    cpu_->draw(drawn_, region);
    const Image<std::uint8_t> mask = moved_silhouette(cpu_->surface(), 13, -9);
    const FillCounts ours = gl_->fill(mask.view(), {}, region),
                     theirs = cpu_->fill(mask.view(), {}, region);
    fill_.add(*cpu_, *gl_, region);
    for (const int difference :
         {ours.lit - theirs.lit, ours.filled - theirs.filled, ours.dark - theirs.dark})
      counts_px_ = std::max(counts_px_, std::abs(difference));
    filled_px_ += theirs.filled;
  }

  static inline std::unique_ptr<GlPainter> gl_;
  static inline std::unique_ptr<Painter> cpu_;
  static inline std::string reason_;

  calib::Calibration calibration_ = calib::reference_rig();
  std::array<Hand, 2> hands_{Hand(Side::left), Hand(Side::right)};
  std::vector<DrawnHand> drawn_;
  Difference draw_, warp_, fill_;
  int counts_px_ = 0, filled_px_ = 0;
};

TEST_P(Parity, EveryPassIsThatOfCpu) {
  const auto motion = twin::make_builtin_motion(GetParam(), {}, calibration_);
  ASSERT_NE(motion, nullptr);
  for (const double seconds : {0.1, 0.63, 1.0, 1.27, 1.9}) {
    const Rect region = pose_hands(*motion, seconds);
    if (!drawn_.empty()) compare_passes(region);
  }
  ASSERT_GT(draw_.lit_px, 50'000);
  ASSERT_GT(filled_px_, 5'000);
  expect_within({5e-5, 1e-6, 2e-6, 2e-4, 0.02, 0}, draw_);
  expect_within({5e-5, 3e-6, 2e-6, 2e-2, 0.03, 0}, warp_);
  expect_within({5e-5, 1e-6, 1e-5, 2e-4, 0.02, 0}, fill_);
  EXPECT_LE(counts_px_, fill_.lit_px / 20'000);
  fmt::print("draw: {}\nwarp: {}\nfill: {}\n      {} px filled; counts differ by up to {} px\n",
             draw_.line(), warp_.line(), fill_.line(), filled_px_, counts_px_);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Parity, testing::ValuesIn(motion_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace handcast::renderer::test
