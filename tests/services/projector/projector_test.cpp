// SPDX-License-Identifier: Apache-2.0
// The contract of all projector back ends, and tests of single ones.
#include "services/projector/projector.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/display_server.hpp"
#ifdef HANDCAST_WITH_KMS
#include "tests/renderer/kms/emulated_card.hpp"
#endif
#include "tests/scratch.hpp"

namespace handcast::projector {
namespace {

using namespace std::chrono_literals;

const renderer::LightTable kLight = renderer::light_table(config::Projector());

/// A dark 32 x 24 frame with a 4 x 4 region at (8, 6). The first pixel of the region is red; its
/// other pixels have alpha 0.
struct SmallFrame {
  SmallFrame() {
    pixels.at(8, 6) = 0xFF0000FF;
    pixels.at(9, 6) = 0x00FFFFFF;
    frame.region = {8, 6, 12, 10};
    frame.colour = pixels.view();
  }
  renderer::Image<std::uint32_t> pixels{32, 24, 0};
  renderer::Frame frame;
};

class ProjectorContract : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
    ::setenv("HANDCAST_OUT", scratch_.path().c_str(), 1);
    rig_.projector.backend = GetParam();
    if (GetParam() == "window") {
      server_.emplace();
      if (!*server_) GTEST_SKIP() << test::DisplayServer::why();
      rig_.projector.window.vsync = false;  // the server's monitors have no refresh
    }
#ifdef HANDCAST_WITH_KMS
    if (GetParam() == "kms") {
      card_.emplace();
      card_->plug_in("HDMI-A-1", "EPSON PJ", {test::timing(32, 24, 100)});
    }
#endif
    calibration_.projector.width_px = 32;
    calibration_.projector.height_px = 24;
    rig_.projector.rate_hz = 100;
    rig_.projector.latency_ms = 4;
    open();
  }
  void open() {
    projector_.reset();
    auto opened = open_projector(rig_, calibration_);
    ASSERT_TRUE(opened) << opened.error().what;
    projector_ = std::move(*opened);
  }
  void TearDown() override { ::unsetenv("HANDCAST_OUT"); }

  test::Scratch scratch_;
  std::optional<test::DisplayServer> server_;
#ifdef HANDCAST_WITH_KMS
  std::optional<test::EmulatedCard> card_;
#endif
  config::Rig rig_;
  calib::Calibration calibration_;
  SmallFrame small_;
  std::unique_ptr<Projector> projector_;
};

TEST_P(ProjectorContract, LightComesTheLatencyAndHalfAPeriodAfterTheFrameWasTaken) {
  const std::int64_t before_ns = now_ns();
  const auto times = projector_->present(small_.frame, 1, kLight, Deadline::in(5s));
  ASSERT_TRUE(times) << times.error().what;
  EXPECT_GE(times->handed_ns, before_ns);
  EXPECT_LE(times->handed_ns, now_ns());
  EXPECT_GE(times->display_ns - times->handed_ns, to_ns(9ms));
  EXPECT_LE(times->display_ns, now_ns() + to_ns(9ms));
}

TEST_P(ProjectorContract, TakesNoMoreThanOneFrameAPeriod) {
  const std::int64_t begin_ns = now_ns();
  for (int i = 0; i < 8; ++i)
    ASSERT_TRUE(projector_->present(small_.frame, i + 1, kLight, Deadline::in(5s)));
  EXPECT_GE(now_ns() - begin_ns, 6 * to_ns(10ms));
}

TEST_P(ProjectorContract, SaysWhoKnowsWhenLightCameAndHowManyRefreshesHadNoNewFrame) {
  const auto first = projector_->present(small_.frame, 1, kLight, Deadline::in(5s));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->note.source, GetParam() == "kms"      ? msg::LightSource::kernel
                                : GetParam() == "window" ? msg::LightSource::window
                                                         : msg::LightSource::settings);
  EXPECT_EQ(first->note.refreshes, 0u) << "there was none before";
  sleep_until_ns(now_ns() + to_ns(45ms));  // the period is 10 ms
  const auto late = projector_->present(small_.frame, 2, kLight, Deadline::in(5s));
  ASSERT_TRUE(late);
  EXPECT_GE(late->note.refreshes, 4u);
  EXPECT_NEAR(late->note.refreshes, static_cast<double>(late->display_ns - first->display_ns) / 1e7,
              1.0);
}

TEST_P(ProjectorContract, ADeadlineInThePastIsATimeoutNotAHang) {
  // A frame that takes longer than a period is not followed by a wait: on a busy machine, a
  // window's takes more than 10 ms. The emulated card has one mode.
  if (GetParam() != "kms") rig_.projector.rate_hz = 5;
  open();
  auto busy = projector_->present(small_.frame, 1, kLight, Deadline::in(5s));
  for (int i = 2; busy && i < 500; ++i)
    busy = projector_->present(small_.frame, i, kLight, Deadline::now());
  ASSERT_FALSE(busy);
  EXPECT_EQ(busy.error().code, Errc::timeout);
  EXPECT_TRUE(projector_->present(small_.frame, 500, kLight, Deadline::in(5s)));
}

TEST(PackedProjector, TheBackEndTakesOutputFramesAtTheirRate) {
  config::Rig rig;
  rig.projector.packing = config::Packing::planes_8x3;
  rig.projector.rate_hz = 800;
  rig.projector.latency_ms = 4;
  const auto projector = open_projector(rig, {});
  ASSERT_TRUE(projector) << projector.error().what;
  const auto times = (*projector)->present(SmallFrame().frame, 1, kLight, Deadline::in(5s));
  ASSERT_TRUE(times);
  EXPECT_EQ(times->display_ns - times->handed_ns, to_ns(4ms) + to_ns(5ms))
      << "half of 8 sub-frames";
}

std::vector<std::string_view> all() { return service::names_of(projector_backends()); }
INSTANTIATE_TEST_SUITE_P(Backends, ProjectorContract, testing::ValuesIn(all()),
                         [](const auto& named) { return std::string(named.param); });

Result<std::unique_ptr<Projector>> open_file_projector(const std::filesystem::path& folder,
                                                       const config::ProjectorFile& file = {}) {
  ::setenv("HANDCAST_OUT", folder.c_str(), 1);
  config::Rig rig;
  rig.projector.backend = "file";
  rig.projector.file = file;
  auto projector = open_projector(rig, {});
  ::unsetenv("HANDCAST_OUT");
  return projector;
}

TEST(FileProjector, WritesWhatIsLitAndNothingElse) {
  test::Scratch scratch;
  auto projector = open_file_projector(scratch.path());
  ASSERT_TRUE(projector) << projector.error().what;
  SmallFrame small;
  small.pixels.at(0, 0) = 0xFFFFFFFF;  // outside the region, as left over from an older frame
  ASSERT_TRUE((*projector)->present(small.frame, 0, kLight, Deadline::in(5s)));
  projector->reset();  // the picture is written

  const cv::Mat picture = cv::imread((scratch.path() / "light" / "light_000.png").string());
  ASSERT_EQ(picture.size(), cv::Size(32, 24));
  EXPECT_EQ(picture.at<cv::Vec3b>(6, 8), cv::Vec3b(0, 0, 255)) << "red, in OpenCV's order";
  EXPECT_EQ(picture.at<cv::Vec3b>(6, 9), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(picture.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 0));
}

TEST(FileProjector, TwoCannotWriteIntoOneFolder) {
  test::Scratch scratch;
  auto first = open_file_projector(scratch.path());
  const auto second = open_file_projector(scratch.path());  // a standby, while the first one works
  SmallFrame small;
  ASSERT_TRUE((*first)->present(small.frame, 1, kLight, Deadline::in(5s)));
  const auto refused = (*second)->present(small.frame, 1, kLight, Deadline::in(5s));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("another rig writes"));
  first->reset();
  EXPECT_TRUE((*second)->present(small.frame, 1, kLight, Deadline::in(5s)));
}

/// Presents a frame that is to be written until it is refused.
Result<PresentTimes> present_until_refused(Projector& projector) {
  SmallFrame small;
  auto times = projector.present(small.frame, 0, kLight, Deadline::in(5s));
  for (const auto limit = Deadline::in(20s); times && !limit.passed();)
    times = projector.present(small.frame, 0, kLight, Deadline::in(5s));
  return times;
}

TEST(FileProjector, SaysWhenAPictureCannotBeWritten) {
  test::Scratch scratch;
  const auto projector = open_file_projector(scratch.path());
  std::filesystem::create_directory(scratch.path() / "light" / "light_000.png");
  const auto refused = present_until_refused(**projector);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_data);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("light_000.png"));
  EXPECT_TRUE((*projector)->present(SmallFrame().frame, 1, kLight, Deadline::in(5s)));
}

/// The pixel that SmallFrame lights, in each picture of a film.
std::vector<cv::Vec3b> lit_pixels_of(const std::filesystem::path& file) {
  std::vector<cv::Vec3b> pixels;
  cv::VideoCapture film(file.string(), cv::CAP_FFMPEG);
  for (cv::Mat picture; film.read(picture);) pixels.push_back(picture.at<cv::Vec3b>(6, 8));
  return pixels;
}

/// Presents `count` frames that are grey, one level brighter each time. Waits until those that are
/// to be written are in the film.
void film_grey_levels(Projector& projector, const std::filesystem::path& file, int count,
                      int every) {
  SmallFrame small;
  for (int i = 0; i < count; ++i) {
    for (int y = 6; y < 10; ++y)
      std::fill_n(small.pixels.row(y) + 8, 4, 0xff000000u | (0x101010u * static_cast<unsigned>(i)));
    ASSERT_TRUE(projector.present(small.frame, i, kLight, Deadline::in(5s)));
    const auto wanted = static_cast<std::size_t>(i / every) + 1;
    for (const auto limit = Deadline::in(20s);
         lit_pixels_of(file).size() < wanted && !limit.passed();)
      sleep_until_ns(now_ns() + to_ns(1ms));
  }
}

TEST(FileProjector, FilmsTheFirstOfSoManyFrames) {
  test::Scratch scratch;
  const auto file = scratch.path() / "light" / "light.avi";
  auto projector = open_file_projector(scratch.path(), {.film = true, .every = 3});
  ASSERT_TRUE(projector) << projector.error().what;
  film_grey_levels(**projector, file, 12, 3);
  projector->reset();
  const auto pixels = lit_pixels_of(file);
  ASSERT_EQ(pixels.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(pixels[static_cast<std::size_t>(i)][0], 3 * i * 16, 6);
}

TEST(FileProjector, BeginsANewFilmAtEachStart) {
  test::Scratch scratch;
  const auto folder = scratch.path() / "light";
  for (int start = 1; start <= 3; ++start) {
    const auto file = folder / (start == 1 ? "light.avi" : fmt::format("light-{}.avi", start));
    const auto projector = open_file_projector(scratch.path(), {.film = true, .every = 1});
    film_grey_levels(**projector, file, 1 + start, 1);
  }
  EXPECT_EQ(lit_pixels_of(folder / "light.avi").size(), 2u);
  EXPECT_EQ(lit_pixels_of(folder / "light-2.avi").size(), 3u);
  EXPECT_EQ(lit_pixels_of(folder / "light-3.avi").size(), 4u);
}

TEST(FileProjector, LeavesOutFramesRatherThanWaitButNeverTheLast) {
  test::Scratch scratch;
  ::setenv("HANDCAST_OUT", scratch.path().c_str(), 1);
  config::Rig rig;
  rig.projector.backend = "file";
  rig.projector.file = {.film = true, .every = 1};
  rig.projector.rate_hz = 10'000;
  auto projector = open_projector(rig, {});
  ::unsetenv("HANDCAST_OUT");
  ASSERT_TRUE(projector);
  renderer::Texture large(2048, 2048, 0xff8040c0);
  renderer::Frame frame;
  frame.colour = large.view();
  frame.region = {0, 0, 8, 8};
  testing::internal::CaptureStderr();
  for (int i = 0; i < 60; ++i) {
    if (i == 59) frame.region = {0, 0, 64, 64};
    ASSERT_TRUE((*projector)->present(frame, i, kLight, Deadline::in(5s)));
  }
  projector->reset();
  const auto log = testing::internal::GetCapturedStderr();
  const auto lit_px = lit_pixels_of(scratch.path() / "light" / "light.avi");
  ASSERT_LT(lit_px.size(), 60u);
  EXPECT_GT(lit_px.back()[0], 100) << "only the last frame is lit here";
  EXPECT_THAT(log, testing::HasSubstr("frames come faster than they can be written"));
  EXPECT_THAT(log, testing::ContainsRegex("[0-9]+ were left out"));
}

TEST(FileProjector, SaysWhenItsFolderCannotBeMade) {
  const auto projector = open_file_projector("/dev/null");
  ASSERT_FALSE(projector);
  EXPECT_EQ(projector.error().code, Errc::bad_config);
  EXPECT_THAT(projector.error().what, testing::HasSubstr("/dev/null/light"));
}

}  // namespace
}  // namespace handcast::projector
