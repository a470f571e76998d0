// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/recorder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

#include "ipc/base/clock.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

using msg::Side;

constexpr calib::CameraModel kCamera{.width_px = 8, .height_px = 6};
constexpr std::int64_t kFrame_ns = 2'000'000;

/// Returns the events of the test, and a camera frame every 2 ms whose pixels all hold its number.
class MadeUpFeed : public SensorFeed {
 public:
  std::vector<SensorEvent> until(std::int64_t) override { return std::exchange(events, {}); }
  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    if (now_ns < kFrame_ns) return std::nullopt;
    const auto origin_ns = now_ns / kFrame_ns * kFrame_ns;
    return Exposure{static_cast<std::uint64_t>(now_ns / kFrame_ns), origin_ns, origin_ns};
  }
  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override {
    ++rendered;
    for (int y = 0; y < pixels.height; ++y)
      std::fill_n(pixels.row(y), pixels.width, static_cast<std::uint8_t>(exposure.frame_id));
  }

  std::vector<SensorEvent> events;
  int rendered = 0;
};

class Recorder : public testing::Test {
 protected:
  Recorder() {
    auto feed = std::make_unique<MadeUpFeed>();
    feed_ = feed.get();
    recorder_ = *RecordingFeed::create(std::move(feed), kCamera, folder_.path());
  }

  /// Adds a message of poses and one of landmarks, both sampled at `ms`.
  void see(std::int64_t ms, std::vector<Side> sides) {
    msg::HandPoses poses;
    msg::Landmarks landmarks;
    poses.header.origin_ns = landmarks.header.origin_ns = ms * 1'000'000;
    for (const Side side : sides) {
      poses.hands[poses.count++].side = side;
      auto& hand = landmarks.hands[landmarks.count++];
      hand.side = side;
      for (auto& point : hand.points) point = {static_cast<float>(ms), 0, 1, 1};
    }
    feed_->events.push_back({0, poses});
    feed_->events.push_back({0, landmarks});
  }
  void save() {
    recorder_->until(0);
    const auto saved = recorder_->save();
    ASSERT_TRUE(saved) << saved.error().what;
  }
  std::vector<double> values_of(const char* name) const {
    const auto array = recording::read_npy(folder_.path() / name);
    EXPECT_TRUE(array) << array.error().what;
    return array ? array->values : std::vector<double>();
  }

  const test::Scratch folder_;
  MadeUpFeed* feed_ = nullptr;
  std::unique_ptr<RecordingFeed> recorder_;
};

TEST_F(Recorder, WritesEveryCameraFrameWhetherAnybodyLooksOrNot) {
  see(1, {Side::left});
  see(2, {Side::left});
  for (const std::int64_t now_ns : {0, 3'000'000, 12'500'000}) recorder_->until(now_ns);
  ASSERT_TRUE(recorder_->save());
  EXPECT_THAT(values_of("camera_timestamps.npy"),
              testing::ElementsAre(2000, 4000, 6000, 8000, 10000, 12000));
  EXPECT_TRUE(std::filesystem::exists(numbered_png(folder_.path() / "camera", 5)));
  EXPECT_FALSE(std::filesystem::exists(numbered_png(folder_.path() / "camera", 6)));
}

TEST_F(Recorder, AnImageThatWasJustWrittenIsNotRenderedAgain) {
  recorder_->until(4'100'000);
  ASSERT_EQ(feed_->rendered, 2);
  renderer::Image<std::uint8_t> image(kCamera.width_px, kCamera.height_px);
  recorder_->image(*recorder_->newest_exposure(4'100'000), image.view());
  EXPECT_EQ(feed_->rendered, 2);
  EXPECT_THAT(image.pixels(), testing::Each(2));
}

TEST_F(Recorder, KeepsTheSamplesOfTheHandsThatMostSamplesHave) {
  see(1, {Side::left});
  see(2, {Side::right});
  see(3, {Side::left});
  see(4, {Side::left, Side::right});
  see(5, {Side::left, Side::left});
  see(6, {});
  see(7, {});
  see(8, {});
  see(9, {Side::left});
  save();
  const auto recording = recording::read_recording(folder_.path());
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_THAT(values_of("timestamps.npy"), testing::ElementsAre(1000, 3000, 9000));
  EXPECT_EQ(recording->hands[0].size(), 3u);
  EXPECT_TRUE(recording->hands[1].empty());
  EXPECT_THAT(values_of("landmarks_timestamps.npy"), testing::ElementsAre(1000, 3000, 9000));
  EXPECT_EQ(recording::read_npy(folder_.path() / "landmarks_left.npy")->shape[0], 3u);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "landmarks_right.npy"));
}

TEST_F(Recorder, SamplesThatOvertookOneAnotherAreReadBackInTheirOrder) {
  for (const int ms : {10, 30, 20, 20, 40}) see(ms, {Side::right});
  save();
  const auto recording = recording::read_recording(folder_.path());
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_EQ(recording->first_ns, 10'000'000);
  EXPECT_THAT(recording->time_ns, testing::ElementsAre(0, 10'000'000, 20'000'000, 30'000'000));
  EXPECT_THAT(values_of("landmarks_timestamps.npy"),
              testing::ElementsAre(10'000, 20'000, 30'000, 40'000));
  EXPECT_EQ(values_of("landmarks_right.npy").at(1 * msg::kLandmarks * 3), 20);
}

TEST_F(Recorder, OneSampleIsNoRecording) {
  see(1, {Side::left});
  recorder_->until(0);
  const auto saved = recorder_->save();
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().what, testing::HasSubstr("fewer than two samples"));
}

std::set<std::string> files_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      names.insert(std::filesystem::relative(entry.path(), folder).string());
  return names;
}

TEST_F(Recorder, RemovesAnEarlierRecordingAndNothingElse) {
  see(1, {Side::left, Side::right});
  see(2, {Side::left, Side::right});
  recorder_->until(9'000'000);
  ASSERT_TRUE(recorder_->save());
  for (const char* own : {"camera/0001.png", "camera/1000000.png", "camera/00000a.png",
                          "camera/000001.jpg", "000001.png", "notes.npy"})
    std::ofstream(folder_.path() / own) << "mine";
  EXPECT_GT(files_in(folder_.path()).size(), 15u);
  recorder_ = *RecordingFeed::create(std::make_unique<MadeUpFeed>(), kCamera, folder_.path());
  EXPECT_THAT(
      files_in(folder_.path()),
      testing::UnorderedElementsAre("camera/0001.png", "camera/1000000.png", "camera/00000a.png",
                                    "camera/000001.jpg", "000001.png", "notes.npy"));
}

TEST(Frames, OfAnEarlierRunAreRemovedAndOtherFilesLeft) {
  const test::Scratch folder;
  for (const char* name : {"000000.png", "000777.png", "hand.png"})
    std::ofstream(folder.path() / name) << "earlier";
  Options options = options_of("baseline", 0.01);
  options.warm_up_s = 0.1;
  options.frames_directory = folder.path().string();
  const auto done = run(options);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_THAT(files_in(folder.path()), testing::UnorderedElementsAre("000000.png", "hand.png"));
  EXPECT_GT(std::filesystem::file_size(folder.path() / "000000.png"), 100u);
}

TEST(Recording, IsNotReplacedWhileItIsPlayed) {
  const test::Scratch folder;
  Options options = options_of("baseline", 0.1);
  add_settings(options, {"camera.rate_hz=100"});
  options.draw_every = 0;
  options.record_directory = folder.path().string();
  ASSERT_TRUE(run(options));
  const auto recorded = files_in(folder.path());
  auto again = options_of("baseline", 0.1);
  add_settings(again, {"twin.motion=" + folder.path().string()});
  auto same = again, pictures = again, linked = again, both = options_of("baseline", 0.1);
  same.record_directory = (folder.path() / ".").string();
  pictures.frames_directory = (folder.path() / "camera").string();
  const test::Scratch elsewhere;
  std::filesystem::create_directory_symlink(folder.path() / "camera", elsewhere.path() / "link");
  linked.frames_directory = (elsewhere.path() / "link").string();
  both.record_directory = (elsewhere.path() / "new").string();
  both.frames_directory = (elsewhere.path() / "new" / "camera").string();
  for (const auto& refused : {same, pictures, linked, both}) {
    const auto done = run(refused);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, Errc::bad_config);
    EXPECT_THAT(done.error().what, testing::HasSubstr("name another one"));
    EXPECT_EQ(files_in(folder.path()), recorded);
  }
  again.frames_directory = (folder.path() / "frames").string();
  for (int time = 0; time < 2; ++time) EXPECT_TRUE(run(again)) << "beside the recording, twice";
}

TEST(Recording, OfARigThatLooksAtNoImageHoldsThemAllTheSame) {
  const test::Scratch folder;
  Options options = options_of("baseline", 0.2);
  add_settings(options, {"camera.rate_hz=100"});
  options.warm_up_s = 0;
  options.draw_every = 0;
  options.record_directory = folder.path().string();
  const auto done = run(options);
  ASSERT_TRUE(done) << done.error().what;
  const auto times_us = recording::read_npy(folder.path() / "camera_timestamps.npy");
  ASSERT_TRUE(times_us) << times_us.error().what;
  ASSERT_GE(times_us->values.size(), 19u);
  for (std::size_t i = 0; i < times_us->values.size(); ++i)
    EXPECT_EQ(times_us->values[i], 1e4 * static_cast<double>(i));
}

}  // namespace
}  // namespace handcast::simulate
