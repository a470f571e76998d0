// SPDX-License-Identifier: Apache-2.0
// The light at the end of a rig, and of a projector that another one replaces.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <span>
#include <vector>

#include "renderer/media/picture.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

namespace fs = std::filesystem;

/// A rig that writes each frame of its light to a file. The parameter is
/// projector.packing.
class Fade : public SystemTest, public testing::WithParamInterface<const char*> {
 protected:
  /// The rig, whose light has been at its full brightness.
  std::unique_ptr<Command> lit_rig(const std::string& packing, int rate_hz) const {
    auto rig = up({"--out", scratch_.path().string(), "--set", "projector.backend=file", "--set",
                   "projector.file.every=1", "--set", "projector.fade_s=1.5", "--set",
                   "supervisor.stop_s=30", "--set", "twin.motion=builtin:still", "--set",
                   "projector.packing=" + packing, "--set",
                   "projector.rate_hz=" + std::to_string(rate_hz)});
    wait_until_light();
    EXPECT_TRUE(eventually([&] { return files().size() > 8; }));
    return rig;
  }
  fs::path folder() const { return scratch_.path() / "light"; }
  /// The files of the frames, oldest first.
  std::vector<fs::path> files() const {
    std::vector<fs::path> files;
    if (fs::exists(folder()))
      for (const auto& entry : fs::directory_iterator(folder()))
        if (entry.path().extension() == ".png") files.push_back(entry.path());
    std::ranges::sort(files, {}, [](const auto& file) { return fs::last_write_time(file); });
    return files;
  }
  /// The light of each picture, as a part of the largest one: the sum of its levels, or, if
  /// each bit is a plane, of its bits.
  static std::vector<double> brightness_of(const std::vector<fs::path>& files, bool is_packed) {
    std::vector<double> sums;
    for (const auto& file : files) {
      const auto picture = renderer::read_picture(file);
      if (!picture) continue;
      double sum = 0;
      for (const auto pixel : picture->pixels())
        sum += is_packed ? std::popcount(pixel & 0xffffff)
                         : (pixel & 255) + (pixel >> 8 & 255) + (pixel >> 16 & 255);
      sums.push_back(sum);
    }
    const double most = sums.empty() ? 0 : *std::ranges::max_element(sums);
    for (auto& sum : sums) sum /= most;
    return sums;
  }
};

TEST_P(Fade, TheLightOfARigFallsToBlackBeforeItEnds) {
  const bool is_packed = std::string_view(GetParam()) == "8x3";
  const auto rig = lit_rig(GetParam(), is_packed ? 40 : 5);
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  const auto light = brightness_of(files(), is_packed);
  ASSERT_GT(light.size(), 8u);
  EXPECT_EQ(light.back(), 0) << "the last frame is black";
  // A busy machine misses frames, sub-frames and the hand itself, so only the end of the fall is
  // judged: its last three frames are dark, but not all of them black.
  const std::span fallen(light.end() - 4, light.end() - 1);
  EXPECT_LT(std::ranges::max(fallen), 0.7) << testing::PrintToString(light);
  EXPECT_GT(std::ranges::max(fallen), 0) << testing::PrintToString(light);
  if (!is_packed) {
    EXPECT_LT(light[light.size() - 2], light[light.size() - 4]) << testing::PrintToString(light);
  }
}

INSTANTIATE_TEST_SUITE_P(Packings, Fade, testing::Values("none", "8x3"),
                         [](const auto& named) { return "Packing_" + std::string(named.param); });

TEST_F(Fade, AProjectorThatAnotherOneReplacesDoesNotFade) {
  const auto rig = lit_rig("none", 5);
  const auto first = folder() / "light_000.png";
  const auto begun = fs::last_write_time(first);
  EXPECT_EQ(handcast({"restart", "projector"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return fs::last_write_time(first) > begun; }))
      << "the successor counts from 0 again";
  const auto succeeded = fs::last_write_time(first);
  auto before = files();
  std::erase_if(before, [&](const auto& file) { return fs::last_write_time(file) >= succeeded; });
  const auto light = brightness_of(before, false);
  ASSERT_GT(light.size(), 5u);
  EXPECT_GT(light.back(), 0.9);
}

}  // namespace
}  // namespace handcast::system_test
