// SPDX-License-Identifier: Apache-2.0
// The sub-frames of a moving hand, from the plan over the pipeline to the bits of an output frame.
#include <gtest/gtest.h>

#include <cmath>

#include "calib/sub_frames.hpp"
#include "config/sections/sub_frames.hpp"
#include "renderer/output/light.hpp"
#include "renderer/output/packing.hpp"
#include "services/projector/sub_frame_plan.hpp"
#include "tests/renderer/output/unpacked.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::projector {
namespace {

using config::Packing;

constexpr std::int64_t kStart_ns = 400 * kMs;

/// A pipeline that has seen a hand move at 1 m/s until kStart_ns.
std::unique_ptr<renderer::Pipeline> fast_hand(const calib::Calibration& calibration) {
  config::Content content;
  content.left = "builtin:white";
  auto pipeline = renderer::Pipeline::create({}, content, {}, calibration);
  EXPECT_TRUE(pipeline);
  for (std::int64_t at_ns = kStart_ns - 100 * kMs; at_ns < kStart_ns; at_ns += 8 * kMs) {
    const float moved_m = static_cast<float>(at_ns - kStart_ns) * 1e-9f;
    (*pipeline)->push(
        at_ns,
        renderer::poses_of(at_ns, {renderer::pose_of(renderer::Side::left, {moved_m, 0, 0})}));
  }
  return std::move(*pipeline);
}

renderer::Texture copy_of(const renderer::Frame& frame) {
  renderer::Texture copy(frame.colour.width, frame.colour.height);
  for (int y = frame.region.y0; y < frame.region.y1; ++y)
    std::copy(frame.colour.row(y) + frame.region.x0, frame.colour.row(y) + frame.region.x1,
              copy.row(y) + frame.region.x0);
  return copy;
}

double light_of(std::uint32_t level) {
  static const auto light = renderer::light_of_levels();
  return light[level & 0xff];
}

/// Whether a bit is not that of its light. Near half of the light it may be either.
bool differs(int bit, double light) {
  return std::abs(light - 0.5) > 0.004 && (bit != 0) != (light > 0.5);
}

/// How many pixels of sub-frame `k` are not those of `drawing`. Not dithered: a bit is lit if its
/// drawing has half of the light.
int differences(Packing packing, renderer::View<const std::uint32_t> output, int k,
                const renderer::Texture& drawing) {
  renderer::Texture colours;
  renderer::Image<int> bits;
  if (packing == Packing::quadrants_4) colours = test::quadrant_of(output, k);
  if (packing == Packing::planes_8x3) colours = test::plane_of_8(output, k);
  if (packing == Packing::planes_24x1) bits = test::plane_of_24(output, k);
  int count = 0;
  for (int y = 0; y < drawing.height(); ++y)
    for (int x = 0; x < drawing.width(); ++x) {
      const std::uint32_t pixel = drawing.at(x, y) >> 24 != 0 ? drawing.at(x, y) : 0xff000000u;
      if (packing == Packing::quadrants_4) {
        count += colours.at(x, y) != pixel;
      } else if (packing == Packing::planes_24x1) {
        count += differs(bits.at(x, y), 0.2126 * light_of(pixel) + 0.7152 * light_of(pixel >> 8) +
                                            0.0722 * light_of(pixel >> 16));
      } else {
        for (const int shift : {0, 8, 16})
          count +=
              differs(static_cast<int>(colours.at(x, y) >> shift & 0xff), light_of(pixel >> shift));
      }
    }
  return count;
}

class MovingHand : public testing::TestWithParam<Packing> {};

TEST_P(MovingHand, EachSubFrameIsTheFrameOfItsOwnTime) {
  config::Projector settings;
  settings.packing = GetParam();
  settings.dither = false;
  settings.rate_hz = 60 * config::sub_frames_of(GetParam());  // predictions end after some 50 ms
  settings.software_ms = 0.2;
  const auto calibration = [&] {
    const auto rig = renderer::rig_above_hand();
    return config::has_half_size(GetParam()) ? calib::with_scaled_projector(rig, 0.5) : rig;
  }();
  const auto output = calib::output_of(calibration, GetParam());
  const auto packer =
      renderer::make_packer(settings, output.projector.width_px, output.projector.height_px);
  const auto drawing = fast_hand(calibration);
  SubFramePlan plan(settings);
  plan.start(kStart_ns);
  packer->begin(1);
  std::vector<std::int64_t> display_ns;
  while (const auto next = plan.next(kStart_ns)) {
    const auto frame = drawing->render(kStart_ns, next->target_ns, {});
    packer->add(frame.colour, frame.region, next->first, next->count);
    plan.drawn(*next, kMs / 10);
    display_ns.push_back(next->target_ns);
  }
  ASSERT_EQ(display_ns.size(), static_cast<std::size_t>(config::sub_frames_of(GetParam())));

  const auto alone = fast_hand(calibration);
  renderer::Texture first;
  for (std::size_t k = 0; k < display_ns.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(display_ns[k] - display_ns[0]),
                static_cast<double>(k) * 1e9 / settings.rate_hz, 50);
    const auto expected = copy_of(alone->render(kStart_ns, display_ns[k], {}));
    if (k == 0) first = expected;
    EXPECT_EQ(differences(GetParam(), packer->image(), static_cast<int>(k), expected), 0) << k;
    if (k > 0) {
      EXPECT_GT(differences(GetParam(), packer->image(), static_cast<int>(k), first), 200) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Packings, MovingHand,
                         testing::Values(Packing::planes_24x1, Packing::planes_8x3,
                                         Packing::quadrants_4),
                         [](const auto& named) {
                           return "of" + std::to_string(config::sub_frames_of(named.param));
                         });

}  // namespace
}  // namespace handcast::projector
