// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "ipc/base/clock.hpp"
#include "services/lab/simulate/detector_tally.hpp"
#include "services/lab/simulate/score.hpp"
#include "services/lab/simulate/simulation.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The folder of MediaPipe's networks; empty if they are missing.
std::filesystem::path models() {
  const char* named = std::getenv("HANDCAST_MODELS");
  const auto folder =
      named && *named ? std::filesystem::path(named) : source_root() / "../shared/models";
  const bool here = std::filesystem::exists(folder / "hand_landmark_lite.onnx") &&
                    std::filesystem::exists(folder / "palm_detection_lite.onnx");
  return here ? folder : std::filesystem::path();
}

#define SKIP_WITHOUT_MODELS() \
  if (models().empty())       \
  GTEST_SKIP() << "../shared/models has no networks; HANDCAST_MODELS names another folder"

constexpr std::int64_t kAge_ns = 7'000'000;

/// Finds no hand in any frame, or cannot use the frames.
class Blind : public FrameDetector {
 public:
  explicit Blind(bool can_use_the_frame) : can_use_the_frame_(can_use_the_frame) {}
  Detection detect(std::uint64_t, const Exposure& exposure) override {
    if (!can_use_the_frame_) return {std::nullopt, kAge_ns, 1};
    msg::Landmarks nothing;
    nothing.header = {exposure.frame_id, exposure.origin_ns, 0};
    return {nothing, kAge_ns, 1};
  }

 private:
  bool can_use_the_frame_;
};

/// Records the tracker samples that it received before each frame.
class Diary : public FrameDetector {
 public:
  struct Page {
    Exposure exposure;
    std::vector<std::uint64_t> samples;  ///< numbers of all samples so far
  };
  explicit Diary(std::vector<Page>& pages) : pages_(pages) {}
  void tell(const msg::HandPoses& poses) override { samples_.push_back(poses.header.frame_id); }
  Detection detect(std::uint64_t, const Exposure& exposure) override {
    pages_.push_back({exposure, samples_});
    return {std::nullopt, kAge_ns, 0};
  }

 private:
  std::vector<Page>& pages_;
  std::vector<std::uint64_t> samples_;
};

/// The hands of a run without drawing.
struct Outcome {
  int hands = 0;           ///< summed over the projector frames
  double error_px = 0;     ///< mean over their landmarks
  int with_landmarks = 0;  ///< hands on a rung that uses landmarks
};

Outcome outcome_of(const std::string& rung, const twin::Twin& world, SensorFeed& feed) {
  const auto rig = rig_with({"cascade.ladder.rung=" + rung});
  auto pipeline =
      renderer::Pipeline::create(rig.cascade, rig.content, rig.hand, calib::reference_rig());
  EXPECT_TRUE(pipeline) << pipeline.error().what;
  Simulation simulation(rig, calib::reference_rig(), **pipeline, feed, 0);
  Outcome outcome;
  while (simulation.now_ns() < 600'000'000)
    simulation.step([&](const Tick& tick) {
      for (const auto& hand : tick.hands) {
        const auto truth = *world.landmarks(hand.side, tick.display_ns);
        for (std::size_t i = 0; i < truth.size(); ++i)
          outcome.error_px += glm::distance(hand.corrected[i], truth[i]) / msg::kLandmarks;
        outcome.with_landmarks += hand.rung > msg::Rung::predict;
        ++outcome.hands;
      }
    });
  outcome.error_px /= outcome.hands;
  return outcome;
}

TEST(SimulatedDetector, OneThatNeverFindsAnythingLeavesTheTrackersLight) {
  const auto world = twin_of(rig_with({"twin.motion=builtin:wave"}));
  const auto alone = outcome_of("predict", *world, *make_twin_feed(*world));
  const auto seeing = outcome_of("register", *world, *make_twin_feed(*world));
  ASSERT_GT(alone.hands, 100);
  EXPECT_GT(seeing.with_landmarks, seeing.hands / 2);
  EXPECT_LT(seeing.error_px, alone.error_px / 3);
  for (const bool can_use_the_frame : {true, false}) {
    const auto blind = outcome_of(
        "register", *world, *make_twin_feed(*world, std::make_unique<Blind>(can_use_the_frame)));
    EXPECT_EQ(blind.hands, alone.hands);
    EXPECT_EQ(blind.with_landmarks, 0);
    EXPECT_NEAR(blind.error_px, alone.error_px, 0.1 * alone.error_px);
  }
}

TEST(SimulatedDetector, KnowsTheTrackersSamplesThatHaveArrivedAndNoOthers) {
  const auto world = twin_of(rig_with({"twin.tracker.age_sd_ms=4"}));
  std::vector<Diary::Page> pages;
  const auto feed = make_twin_feed(*world, std::make_unique<Diary>(pages));
  for (std::int64_t now_ns = 0; now_ns < 500'000'000; now_ns += 20'000'000)
    feed->until(now_ns);  // several runs per call
  ASSERT_GT(pages.size(), 50u);
  std::int64_t free_ns = 0;
  for (const auto& [exposure, samples] : pages) {
    const auto begin_ns = std::max(free_ns, world->camera_arrival_ns(exposure.frame_id));
    std::vector<std::pair<std::int64_t, std::uint64_t>> arrived;
    for (std::uint64_t k = 0; world->tracker_time_ns(k) <= begin_ns; ++k)
      if (const auto at_ns = world->tracker_sample(k).arrival_ns; at_ns <= begin_ns)
        arrived.emplace_back(at_ns, k);
    std::ranges::sort(arrived);
    std::vector<std::uint64_t> expected;
    expected.reserve(arrived.size());
    for (const auto& sample : arrived) expected.push_back(sample.second);
    ASSERT_EQ(samples, expected) << "frame " << exposure.frame_id;
    free_ns = exposure.origin_ns + kAge_ns;
  }
}

TEST(SimulatedDetector, LostFramesReachNobody) {
  const auto world = twin_of(rig_with({"twin.image.lost=0.4", "twin.image.burst=0.2"}));
  std::vector<Diary::Page> pages;
  const auto feed = make_twin_feed(*world, std::make_unique<Diary>(pages));
  std::set<std::uint64_t> shown;
  for (std::int64_t now_ns = 0; now_ns < 500'000'000; now_ns += 500'000) {
    feed->until(now_ns);
    if (const auto newest = feed->newest_exposure(now_ns)) {
      EXPECT_LE(world->camera_arrival_ns(newest->frame_id), now_ns);
      shown.insert(newest->frame_id);
    }
  }
  EXPECT_GT(pages.size(), 40u);
  EXPECT_NEAR(static_cast<double>(shown.size()), 0.5 * 525 * 0.6 * 0.8, 20);
  for (const auto& page : pages) shown.insert(page.exposure.frame_id);
  for (const auto frame : shown) EXPECT_FALSE(world->camera_lost(frame)) << frame;
}

TEST(SimulatedDetector, ACameraThatLosesEveryFrameIsNoEndlessLoop) {
  const auto world = twin_of(rig_with({"twin.image.lost=1"}));
  const auto feed = make_twin_feed(*world);
  for (std::int64_t now_ns = 0; now_ns < 100'000'000; now_ns += 1'000'000)
    for (const auto& event : feed->until(now_ns))
      EXPECT_FALSE(std::holds_alternative<msg::Landmarks>(event.message));
  EXPECT_FALSE(feed->newest_exposure(100'000'000));
}

TEST(SimulatedDetector, ImagesAndDetectionsCarryTheCamerasStamp) {
  const auto world =
      twin_of(rig_with({"twin.image.clock_jitter_ms=0.3", "twin.detector.age_sd_ms=0"}));
  const auto feed = make_twin_feed(*world);
  std::size_t detections = 0;
  for (std::int64_t now_ns = 0; now_ns < 300'000'000; now_ns += 1'000'000) {
    for (const auto& event : feed->until(now_ns))
      if (const auto* found = std::get_if<msg::Landmarks>(&event.message)) {
        EXPECT_EQ(found->header.origin_ns, world->camera_stamp_ns(found->header.frame_id));
        ++detections;
      }
    const auto newest = feed->newest_exposure(now_ns);
    if (!newest) continue;
    EXPECT_EQ(newest->origin_ns, world->camera_origin_ns(newest->frame_id));
    EXPECT_EQ(newest->stamp_ns, world->camera_stamp_ns(newest->frame_id));
  }
  EXPECT_GT(detections, 10u);
}

TEST(SimulatedDetector, TakesTheNewestFrameWhenItIsFree) {
  const auto world = twin_of(rig_with({}));
  std::vector<Diary::Page> pages;
  const auto feed = make_twin_feed(*world, std::make_unique<Diary>(pages));
  for (std::int64_t now_ns = 0; now_ns < 200'000'000; now_ns += 1'000'000) feed->until(now_ns);
  for (std::size_t i = 1; i < pages.size(); ++i) {
    const auto free_ns = pages[i - 1].exposure.origin_ns + kAge_ns;
    EXPECT_LE(world->camera_arrival_ns(pages[i].exposure.frame_id), free_ns);
    EXPECT_GT(world->camera_arrival_ns(pages[i].exposure.frame_id + 1), free_ns);
  }
}

TEST(DetectorTally, CountsMissedAndInventedHandsAndTheErrorOfTheOthers) {
  const auto world = twin_of(
      rig_with({"twin.motion=builtin:two_hands", "twin.hands=left", "twin.detector.noise_px=2"}));
  const auto model = make_twin_detector(*world);
  DetectorTally tally(*world, calib::reference_rig().camera);
  for (std::uint64_t frame = 0; frame < 200; ++frame) {
    const Exposure exposure{frame, world->camera_origin_ns(frame), world->camera_stamp_ns(frame)};
    auto detection = model->detect(frame, exposure);
    ASSERT_EQ(detection.landmarks->count, 1u);
    if (frame < 10) detection.landmarks->count = 0;
    if (frame >= 10 && frame < 15) detection.landmarks->hands[0].side = msg::Side::right;
    tally.add(exposure, detection);
  }
  const auto json = tally.to_json();
  EXPECT_EQ(json["runs"], 200);
  EXPECT_EQ(json["hands"], 200);
  EXPECT_EQ(json["missed"], 15);
  EXPECT_EQ(json["invented"], 5);
  EXPECT_NEAR(json["error_px"]["p50"], 2 * 1.177, 0.1);  // the median of a Rayleigh distribution
  EXPECT_TRUE(json["ms_p50"].is_null());
}

TEST(SimulatedDetector, AMissingModelIsOneSentence) {
  const test::Scratch empty;
  Options options = options_of("twin", 1);
  add_settings(options,
               {"landmarks.backend=mediapipe", "landmarks.models=" + empty.path().string()});
  const auto done = run(options);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::bad_config);
  EXPECT_THAT(done.error().what,
              AllOf(HasSubstr((empty.path() / "hand_landmark_lite.onnx").string()),
                    HasSubstr("scripts/get-models"), Not(HasSubstr("\n"))));
}

TEST(SimulatedDetector, ABackEndThatIsNotThereIsNamedBesideThoseThatAre) {
  Options options = options_of("twin", 1);
  add_settings(options, {"landmarks.backend=eagle"});
  const auto done = run(options);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().what, AllOf(HasSubstr("eagle"), HasSubstr("handcast, mediapipe, twin"),
                                       Not(HasSubstr("\n"))));
}

/// config/rigs/paper.toml as it is shipped, with the folder of MediaPipe's files.
nlohmann::json run_shipped_paper(const std::filesystem::path& models) {
  auto rig = config::load_rig(source_root() / "config/rigs/paper.toml",
                              {"twin.motion=builtin:wave", "landmarks.models=" + models.string()});
  EXPECT_TRUE(rig) << rig.error().what;
  auto options = options_of("paper", 0.05);
  options.warm_up_s = 0;
  options.draw_every = 0;
  const auto json = score(*rig, calib::reference_rig(), options);
  EXPECT_TRUE(json) << json.error().what;
  return json ? (*json)["detector"] : nlohmann::json();
}

TEST(SimulatedDetector, ThePapersRigWithoutMediaPipesFilesRunsTheModelAndSaysWhichFileIsMissing) {
  const test::Scratch empty;
  const auto detector = run_shipped_paper(empty.path());
  EXPECT_EQ(detector["backend"], "twin");
  EXPECT_THAT(detector["why"].get<std::string>(),
              AllOf(HasSubstr((empty.path() / "hand_landmark_lite.onnx").string()),
                    HasSubstr("'mediapipe'"), HasSubstr("'twin'")));
}

TEST(SimulatedDetector, ThePapersRigRunsMediaPipeIfItsFilesAreThere) {
  SKIP_WITHOUT_MODELS();
  const auto detector = run_shipped_paper(models());
  EXPECT_EQ(detector["backend"], "mediapipe");
  EXPECT_TRUE(detector["why"].is_null());
  EXPECT_EQ(detector["age_ms"], 16.2);
}

TEST(SimulatedDetector, FaultsAndOutliersAlsoSpoilARealOne) {
  const auto detector_with = [](const std::vector<std::string>& faults) {
    auto settings = faults;
    settings.insert(settings.end(), {"landmarks.backend=handcast", "twin.detector.age_ms=5"});
    return run_rig("twin", "builtin:wave", 0.3, settings, 0)["detector"];
  };
  const auto clean = detector_with({});
  EXPECT_EQ(clean["missed"], 0);
  const auto lost = detector_with({"twin.detector.lost_at_s=0.6", "twin.detector.lost_s=0.1"});
  EXPECT_NEAR(lost["missed"].get<double>() / lost["hands"].get<double>(), 1. / 3, 0.05);
  const auto far = detector_with({"twin.detector.outliers=0.2"});
  EXPECT_GT(figure(far, "/error_px/p95"), figure(clean, "/error_px/p95") + 40);
  const auto wrong =
      detector_with({"twin.detector.wrong_finger_at_s=0.5", "twin.detector.wrong_finger_s=0.3"});
  EXPECT_GT(figure(wrong, "/error_px/mean"), 2 * figure(clean, "/error_px/mean"));
}

TEST(SimulatedDetector, TheSameSeedGivesTheSameFiguresTwice) {
  SKIP_WITHOUT_MODELS();
  const auto figures = [](const std::string& seed) {
    auto json = run_rig("twin", "builtin:open_close", 0.1,
                        {"landmarks.backend=mediapipe", "landmarks.models=" + models().string(),
                         "twin.seed=" + seed});
    for (const char* time : {"frame_us", "stage_us"}) json.erase(time);
    EXPECT_TRUE(json["detector"]["ms_p50"].is_number());
    json["detector"].erase("ms_p50");
    return json;
  };
  const auto first = figures("1");
  EXPECT_EQ(first, figures("1"));
  EXPECT_NE(first["detector"], figures("2")["detector"]);
}

TEST(SimulatedDetector, ARealOneFollowsTheTwinsHandAndItsAgeIsTheOneThatIsSet) {
  SKIP_WITHOUT_MODELS();
  const auto json = run_rig("twin", "builtin:wave", 0.5,
                            {"landmarks.backend=mediapipe", "landmarks.models=" + models().string(),
                             "twin.detector.age_ms=8", "twin.detector.age_sd_ms=0"});
  const auto& detector = json["detector"];
  EXPECT_EQ(detector["backend"], "mediapipe");
  EXPECT_EQ(detector["missed"], 0);
  EXPECT_LT(detector["error_px"]["p50"], 15);
  // Every third frame: the newest one is 1.2 to 3.1 ms old when a run begins.
  EXPECT_NEAR(detector["runs"], 500 / 5.7, 3);
}

}  // namespace
}  // namespace handcast::simulate
