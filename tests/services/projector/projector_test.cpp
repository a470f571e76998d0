// SPDX-License-Identifier: Apache-2.0
// The contract of all projector back ends, and tests of single ones.
#include "services/projector/projector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <opencv2/imgcodecs.hpp>

#include "services/projector/show_sub_frames.hpp"
#include "tests/display_server.hpp"
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
    calibration_.projector_width_px = 32;
    calibration_.projector_height_px = 24;
    rig_.projector.rate_hz = 100;
    rig_.projector.latency_ms = 4;
    auto opened = open_projector(rig_, calibration_);
    ASSERT_TRUE(opened) << opened.error().what;
    projector_ = std::move(*opened);
  }
  void TearDown() override { ::unsetenv("HANDCAST_OUT"); }

  test::Scratch scratch_;
  std::optional<test::DisplayServer> server_;
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
  EXPECT_GE(times->lit_ns - times->handed_ns, to_ns(9ms));
  EXPECT_LE(times->lit_ns, now_ns() + to_ns(9ms));
}

TEST_P(ProjectorContract, TakesNoMoreThanOneFrameAPeriod) {
  const std::int64_t begin_ns = now_ns();
  for (int i = 0; i < 8; ++i)
    ASSERT_TRUE(projector_->present(small_.frame, i + 1, kLight, Deadline::in(5s)));
  EXPECT_GE(now_ns() - begin_ns, 6 * to_ns(10ms));
}

TEST_P(ProjectorContract, ADeadlineInThePastIsATimeoutNotAHang) {
  for (int i = 1; i <= 4; ++i)  // the first one may be slow, and then the others follow at once
    ASSERT_TRUE(projector_->present(small_.frame, i, kLight, Deadline::in(5s)));
  const auto busy = projector_->present(small_.frame, 5, kLight, Deadline::now());
  ASSERT_FALSE(busy);
  EXPECT_EQ(busy.error().code, Errc::timeout);
  EXPECT_TRUE(projector_->present(small_.frame, 6, kLight, Deadline::in(5s)));
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
  EXPECT_EQ(times->lit_ns - times->handed_ns, to_ns(4ms) + to_ns(5ms)) << "half of 8 sub-frames";
}

std::vector<std::string_view> all() { return service::names_of(projector_backends()); }
INSTANTIATE_TEST_SUITE_P(Backends, ProjectorContract, testing::ValuesIn(all()),
                         [](const auto& named) { return std::string(named.param); });

Result<std::unique_ptr<Projector>> open_file_projector(const std::filesystem::path& folder) {
  ::setenv("HANDCAST_OUT", folder.c_str(), 1);
  config::Rig rig;
  rig.projector.backend = "file";
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
  const auto second = open_file_projector(scratch.path());  // a spare, while the first one works
  SmallFrame small;
  ASSERT_TRUE((*first)->present(small.frame, 1, kLight, Deadline::in(5s)));
  const auto refused = (*second)->present(small.frame, 1, kLight, Deadline::in(5s));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("another rig writes"));
  first->reset();
  EXPECT_TRUE((*second)->present(small.frame, 1, kLight, Deadline::in(5s)));
}

TEST(FileProjector, SaysWhenAPictureCannotBeWritten) {
  test::Scratch scratch;
  const auto projector = open_file_projector(scratch.path());
  std::filesystem::create_directory(scratch.path() / "light" / "light_000.png");
  SmallFrame small;
  ASSERT_TRUE((*projector)->present(small.frame, 0, kLight, Deadline::in(5s)));
  const auto refused = (*projector)->present(small.frame, 100, kLight, Deadline::in(5s));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_data);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("light_000.png"));
  EXPECT_TRUE((*projector)->present(small.frame, 200, kLight, Deadline::in(5s)));
}

TEST(FileProjector, SaysWhenItsFolderCannotBeMade) {
  const auto projector = open_file_projector("/dev/null");
  ASSERT_FALSE(projector);
  EXPECT_EQ(projector.error().code, Errc::bad_config);
  EXPECT_THAT(projector.error().what, testing::HasSubstr("/dev/null/light"));
}

}  // namespace
}  // namespace handcast::projector
