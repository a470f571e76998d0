// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/simulation.hpp"

#include <gmock/gmock.h>

#include <map>

#include "ipc/base/clock.hpp"
#include "services/lab/simulate/score.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

std::unique_ptr<renderer::Pipeline> pipeline_of(const config::Rig& rig) {
  auto pipeline =
      renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calib::reference_rig());
  EXPECT_TRUE(pipeline) << pipeline.error().what;
  return std::move(*pipeline);
}

/// Records the output of a feed and, after rewind(), plays it without the feed.
class Tape : public SensorFeed {
 public:
  explicit Tape(SensorFeed* source) : source_(source) {}

  void rewind() {
    source_ = nullptr;
    next_ = 0;
  }
  std::vector<SensorEvent> until(std::int64_t now_ns) override {
    if (!source_) return events_.at(next_++);
    return events_.emplace_back(source_->until(now_ns));
  }
  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    if (source_) exposures_[now_ns] = source_->newest_exposure(now_ns);
    return exposures_.at(now_ns);
  }
  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override {
    auto& kept = images_[exposure.frame_id];
    const auto size =
        static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
    if (source_) {
      source_->image(exposure, pixels);
      kept.assign(pixels.data, pixels.data + size);
    }
    std::copy(kept.begin(), kept.end(), pixels.data);
  }

 private:
  SensorFeed* source_;
  std::size_t next_ = 0;
  std::vector<std::vector<SensorEvent>> events_;
  std::map<std::int64_t, std::optional<Exposure>> exposures_;
  std::map<std::uint64_t, std::vector<std::uint8_t>> images_;
};

/// The FNV-1a hash of the light of all drawn frames, and its mean error if there is a judge.
std::uint64_t light_of(const config::Rig& rig, SensorFeed& feed, twin::Judge* judge = nullptr,
                       double* error_px = nullptr) {
  const auto pipeline = pipeline_of(rig);
  Simulation simulation(rig, calib::reference_rig(), *pipeline, feed, 16);
  std::uint64_t hash = 14695981039346656037ull;
  double sum = 0;
  std::size_t count = 0;
  while (simulation.now_ns() < 600'000'000)
    simulation.step([&](const Tick& tick) {
      if (!tick.projection) return;
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(tick.projection->pixels());
      for (std::size_t i = 0; i < tick.projection->used_bytes() - sizeof(msg::Projection); ++i)
        hash = (hash ^ bytes[i]) * 1099511628211ull;
      if (!judge) return;
      for (const auto& hand : judge->score(*tick.projection).hands)
        for (const float px : hand.interior_px) sum += px, ++count;
    });
  if (error_px) *error_px = count ? sum / static_cast<double>(count) : 0;
  return hash;
}

TEST(Simulation, TheCascadeSeesSensorsOnly) {
  const auto rig = rig_with({"twin.motion=builtin:wave"});
  const auto world = twin_of(rig);
  const auto other_world = twin_of(rig_with({"twin.motion=builtin:rotate", "twin.seed=9"}));
  const auto feed = make_twin_feed(*world);
  Tape tape(feed.get());
  const auto judge = twin::Judge::create(*world, 4);
  const auto other_judge = twin::Judge::create(*other_world, 4);

  double error_px = 0, other_error_px = 0;
  const auto light = light_of(rig, tape, judge.get(), &error_px);
  tape.rewind();
  const auto light_under_another_truth = light_of(rig, tape, other_judge.get(), &other_error_px);

  EXPECT_EQ(light, light_under_another_truth);
  EXPECT_GT(other_error_px, 3 * error_px);  // the judges use different truths
}

TEST(Simulation, TheSameSeedGivesTheSameFiguresTwice) {
  auto first = run_rig("twin", "builtin:open_close", 0.4);
  auto second = run_rig("twin", "builtin:open_close", 0.4);
  for (auto* figures : {&first, &second})
    for (const char* time : {"frame_us", "stage_us"}) figures->erase(time);
  EXPECT_EQ(first, second);
}

TEST(Simulation, AnotherSeedGivesOtherFigures) {
  const auto first = run_rig("twin", "builtin:open_close", 0.4);
  const auto second = run_rig("twin", "builtin:open_close", 0.4, {"twin.seed=2"});
  EXPECT_NE(first["interior_mm"], second["interior_mm"]);
}

TEST(TwinFeed, MessagesArriveInOrderAndAtTheirAge) {
  const auto rig = rig_with({"twin.tracker.age_ms=9.1", "twin.detector.age_ms=16.2"});
  const auto world = twin_of(rig);
  const auto feed = make_twin_feed(*world);
  std::int64_t last_ns = 0;
  double pose_age_ms = 0, landmark_age_ms = 0;
  int poses = 0, landmarks = 0;
  for (std::int64_t now_ns = 0; now_ns < 2'000'000'000; now_ns += 1'000'000)
    for (const auto& event : feed->until(now_ns)) {
      EXPECT_GE(event.arrival_ns, last_ns);
      EXPECT_LE(event.arrival_ns, now_ns);
      last_ns = event.arrival_ns;
      if (const auto* pose = std::get_if<msg::HandPoses>(&event.message)) {
        pose_age_ms += ns_to_ms(event.arrival_ns - pose->header.origin_ns);
        ++poses;
      } else {
        landmark_age_ms +=
            ns_to_ms(event.arrival_ns - std::get<msg::Landmarks>(event.message).header.origin_ns);
        ++landmarks;
      }
    }
  EXPECT_NEAR(poses, 2 * 110.6, 4);
  EXPECT_NEAR(pose_age_ms / poses, 9.1, 0.2);
  EXPECT_NEAR(landmark_age_ms / landmarks, 16.2, 0.6);
  // Back to back: a frame is about 2.2 ms old when a run begins.
  EXPECT_NEAR(landmarks, 2000 / 14.0, 8);
}

TEST(Recording, LandmarksSurviveDetectionsThatFoundNothing) {
  const test::Scratch folder;
  Options options = options_of("twin", 0.5);
  add_settings(options,
               {"twin.detector.dropout=0.6", "camera.rate_hz=100"});  // writes fewer images
  options.draw_every = 64;
  options.record_directory = folder.path().string();
  for (int seed = 1; seed <= 3; ++seed) {  // the first detection without a hand varies
    options.settings.push_back("twin.seed=" + std::to_string(seed));
    const auto done = run(options);
    ASSERT_TRUE(done) << done.error().what;
    const auto landmarks = recording::read_npy(folder.path() / "landmarks_left.npy");
    ASSERT_TRUE(landmarks) << landmarks.error().what;
    EXPECT_GT(landmarks->shape[0], 10u);
    EXPECT_EQ(landmarks->shape[2], 3u) << "x, y and sigma";
  }
}

TEST(Recording, AFolderThatCannotBeCreatedIsSaidBeforeTheRun) {
  const test::Scratch folder;
  std::ofstream(folder.path() / "camera") << "a file instead of the folder of the pictures";
  Options options = options_of("twin", 1000);
  options.record_directory = folder.path().string();
  const auto done = run(options);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, testing::HasSubstr("cannot be created"));
}

Options short_run() {
  Options options = options_of("twin", 0.1);
  return options;
}

TEST(Simulation, FiguresThatCannotBeWrittenAreRefusedBeforeTheRun) {
  const test::Scratch folder;
  auto options = short_run();
  options.trace_file = (folder.path() / "trace.csv").string();
  for (const auto& file : {folder.path() / "nowhere" / "metrics.json", folder.path()}) {
    options.json_file = file.string();
    const auto done = run(options);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, Errc::bad_config);
    EXPECT_THAT(done.error().what, testing::HasSubstr(file.string()));
    EXPECT_FALSE(std::filesystem::exists(options.trace_file)) << "the rig has run";
  }
}

TEST(Simulation, AFullDiskCostsTheFileButNotTheSummary) {
  auto options = short_run();
  options.json_file = "/dev/full";
  testing::internal::CaptureStdout();
  const auto done = run(options);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), testing::HasSubstr("interior error mean"));
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, testing::HasSubstr("/dev/full"));
}

TEST(Simulation, ATraceThatIsCutShortIsSaid) {
  auto options = short_run();
  options.trace_file = "/dev/full";
  const auto done = run(options);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, testing::HasSubstr("/dev/full: could not be written"));
}

TEST(Simulation, ANameThatIsNotUtf8IsWrittenAllTheSame) {
  const test::Scratch folder;
  auto recorded = short_run(), options = short_run();
  recorded.record_directory = (folder.path() / "caf\xe9").string();
  add_settings(recorded, {"camera.rate_hz=30"});  // writes fewer images
  ASSERT_TRUE(run(recorded));
  add_settings(options, {"twin.motion=" + recorded.record_directory});
  options.json_file = (folder.path() / "metrics.json").string();
  const auto done = run(options);
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(options.json_file))["motion"],
            (folder.path() / "caf\xef\xbf\xbd").string());
}

TEST(Simulation, TheHandsSpeedDoesNotDependOnWhetherItIsLit) {
  const auto rig = config::load_rig(source_root() / "config/rigs/baseline.toml",
                                    plain("baseline", {"twin.motion=builtin:wave"}));
  ASSERT_TRUE(rig) << rig.error().what;
  auto blind = *rig;
  blind.twin.tracker.lost = {0.2, 0.6};
  auto options = short_run();
  options.seconds = 1;
  options.draw_every = 0;
  const auto lit = score(*rig, calib::reference_rig(), options),
             dark = score(blind, calib::reference_rig(), options);
  ASSERT_TRUE(lit && dark);
  EXPECT_GT((*dark)["fault"]["dark_ms"], 100) << "the light must go out";
  EXPECT_EQ((*dark)["hand_speed_m_s"], (*lit)["hand_speed_m_s"]);
}

// A drawn frame may be shown later than those after it, which are not drawn, and more than once.
TEST(Simulation, TheTremblingOfTheLandmarksDoesNotDependOnWhenTheirLightIsShown) {
  // Late registration smooths its steps from one frame to the next.
  const auto trembling = [](std::vector<std::string> settings) {
    settings.push_back("cascade.register.method=none");
    return figure(run_rig("twin", "builtin:still", 0.5, settings, 15), "/landmark_jitter_px");
  };
  const auto in_time = trembling({});
  EXPECT_EQ(trembling({"twin.projector.work_ms=1.6"}), in_time);
  EXPECT_EQ(trembling({"twin.projector.work_ms=1", "twin.projector.stalls=0.01",
                       "twin.projector.stall_ms=20"}),
            in_time);
}

TEST(Simulation, ABrokenRecordingIsOneSentence) {
  Options options = options_of("twin", 1);
  add_settings(options, {"twin.motion=/nowhere/at/all"});
  const auto done = run(options);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::bad_config);
  EXPECT_THAT(done.error().what, testing::HasSubstr("/nowhere/at/all"));
}

TEST(Refreshes, AFrameThatIsLateLeavesTheLightOfTheOneBeforeOn) {
  config::Projector projector;
  projector.rate_hz = 120;  // every frame is finished before the next begins
  projector.software_ms = 1;
  Refreshes never(projector, {}, 1);
  Refreshes seldom(projector, {.work_ms = 0.7, .work_spread = 0.17}, 1);
  Refreshes half(projector, {.work_ms = 1, .work_spread = 0.17}, 1);
  int seldom_late = 0, half_late = 0;
  for (std::int64_t k = 1; k <= 2000; ++k) {
    EXPECT_EQ(never.shown_at(k), k);
    EXPECT_LE(half.shown_at(k), k);
    EXPECT_GE(half.shown_at(k + 1), half.shown_at(k)) << "light does not go back in time";
    seldom_late += seldom.shown_at(k) != k;
    half_late += half.shown_at(k) != k;
  }
  EXPECT_NEAR(half_late, 1000, 100) << "half of the frames take longer than their median";
  EXPECT_NEAR(seldom_late, 2000 * 0.018, 25);
}

TEST(Refreshes, AFrameThatTakesLongerThanARefreshLeavesTheNextWithoutOne) {
  config::Projector projector;
  projector.rate_hz = 1000;
  projector.software_ms = 2;
  Refreshes refreshes(projector, {.work_ms = 1.6, .work_spread = 0}, 1);
  for (std::int64_t k = 0; k < 100; ++k) EXPECT_EQ(refreshes.shown_at(k), k - k % 2) << k;
}

TEST(Refreshes, AStallIsShownAsOneOldFrameForItsWholeLength) {
  config::Projector projector;
  projector.rate_hz = 1000;
  projector.software_ms = 1;
  Refreshes refreshes(projector, {.work_ms = 0.1, .work_spread = 0, .stalls = 1, .stall_ms = 4.5},
                      1);
  // Frames begin every 5 ms, when the one before is finished, and are shown 4 refreshes late.
  for (std::int64_t k = 4; k < 100; ++k) EXPECT_EQ(refreshes.shown_at(k), (k - 4) / 5 * 5) << k;
}

TEST(Refreshes, AnyOrderOfQuestionsGetsTheSameAnswers) {
  config::Projector projector;
  const config::TwinProjector errors{.work_ms = 1.6, .work_spread = 0.3, .stalls = 0.05};
  Refreshes upwards(projector, errors, 1), from_the_end(projector, errors, 1);
  from_the_end.shown_at(500);
  for (std::int64_t k = 0; k < 500; ++k) EXPECT_EQ(upwards.shown_at(k), from_the_end.shown_at(k));
}

TEST(Simulation, LightThatStaysOnBecauseEverySecondFrameIsLateIsWorse) {
  const std::vector<std::string> all{"projector.rate_hz=120"};
  auto late = all;  // half of the frames take longer than the 1.2 ms of projector.software_ms
  late.insert(late.end(), {"twin.projector.work_ms=1.2", "twin.projector.work_spread=0.17"});
  const auto worse = run_rig("twin", "builtin:shake", 0.6, late, 1),
             normal = run_rig("twin", "builtin:shake", 0.6, all, 1);
  EXPECT_GT(figure(worse, "/interior_mm/mean"), 1.3 * figure(normal, "/interior_mm/mean"));
}

}  // namespace
}  // namespace handcast::simulate
