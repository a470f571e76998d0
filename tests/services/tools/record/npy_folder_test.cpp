// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/npy_folder.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "renderer/media/picture.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::record {
namespace {

TEST(NpyFolder, HoldsTheSamplesAndImagesOfTheRecording) {
  test::Scratch scratch;
  const auto folder = scratch.path() / "recording";
  recording::test::write(folder, 5);
  const auto written = write_npy_folder(folder);
  ASSERT_TRUE(written) << written.error().what;

  const auto times_ns = recording::read_stamps_ns(folder / "npy/camera_timestamps.npy");
  ASSERT_TRUE(times_ns) << times_ns.error().what;
  EXPECT_THAT(*times_ns,
              testing::ElementsAre(1'000'000, 2'000'000, 3'000'000, 4'000'000, 5'000'000));
  const auto picture = renderer::read_camera_picture(folder / "npy/camera/000003.png");
  ASSERT_TRUE(picture) << picture.error().what;
  const auto frame = recording::test::frame(3);
  EXPECT_EQ(
      std::memcmp(picture->grey.pixels().data(), frame->pixels(), picture->grey.pixels().size()),
      0);
  EXPECT_TRUE(std::filesystem::exists(folder / "npy/joints_right.npy"));
  EXPECT_FALSE(std::filesystem::exists(folder / "npy/joints_left.npy"));
}

TEST(NpyFolder, WithoutAHandItHasTheTimesOfTheImages) {
  test::Scratch scratch;
  const auto folder = scratch.path() / "recording";
  recording::test::write(folder, 5);
  for (const auto* ending : {".data", ".index"})
    std::filesystem::resize_file(folder / (std::string("pose.hands") + ending), 0);
  EXPECT_FALSE(write_npy_folder(folder)) << "it says that there is no hand";
  const auto times_ns = recording::read_stamps_ns(folder / "npy/camera_timestamps.npy");
  ASSERT_TRUE(times_ns) << times_ns.error().what;
  EXPECT_EQ(times_ns->size(), 5u);
}

TEST(NpyFolder, DoesNotOverwriteAnEarlierOne) {
  test::Scratch scratch;
  const auto folder = scratch.path() / "recording";
  recording::test::write(folder, 5);
  ASSERT_TRUE(write_npy_folder(folder));
  const auto again = write_npy_folder(folder);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Errc::bad_config);
}

TEST(NpyFolder, AFolderWithoutARecordingIsRefused) {
  test::Scratch scratch;
  EXPECT_FALSE(write_npy_folder(scratch.path()));
}

}  // namespace
}  // namespace handcast::record
