// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <set>

#include "tests/config/every_setting.hpp"
#include "tests/services/lab/sweep/plans.hpp"

/// Tests of the plans in config/sweeps.
namespace handcast::sweep {
namespace {

/// The rigs of a shipped plan by variant, on the first motion of its grid, in the plan's order.
std::vector<std::pair<std::string, config::Rig>> rigs_of(const std::string& name) {
  const auto plan = load_plan(source_root() / "config/sweeps" / (name + ".toml"));
  EXPECT_TRUE(plan) << plan.error().what;
  const auto expansion = expand(*plan);
  EXPECT_TRUE(expansion) << expansion.error().what;
  std::vector<std::pair<std::string, config::Rig>> rigs;
  for (const auto& run : expansion->runs)
    if (const auto& variant = plan->variants[run.variant].name;
        rigs.empty() || rigs.back().first != variant)
      rigs.emplace_back(variant, *rig_of(*plan, run));
  return rigs;
}

config::Rig shipped(const std::string& name) {
  const auto rig = config::load_rig(source_root() / "config/rigs" / (name + ".toml"));
  EXPECT_TRUE(rig) << rig.error().what;
  return *rig;
}

/// The settings in which two rigs differ, of those that begin with one of these words.
std::vector<std::string> differences_in(const config::Rig& a, const config::Rig& b,
                                        const std::vector<std::string>& words) {
  auto paths = config::differences(a, b);
  std::erase_if(paths, [&](const std::string& path) {
    return std::ranges::none_of(words,
                                [&](const std::string& word) { return path.starts_with(word); });
  });
  return paths;
}

TEST(ShippedPlans, WithEachDetectorBothCascadesHaveTheSameTimesAndTheSameWorld) {
  std::map<std::string, config::Rig> rigs;
  for (const auto& [name, rig] : rigs_of("comparison")) rigs.emplace(name, rig);
  for (const auto& [paper, ours] :
       {std::pair("paper_network", "handcast"), std::pair("paper_mediapipe", "handcast_mediapipe"),
        std::pair("paper_model", "handcast_model")}) {
    EXPECT_THAT(differences_in(rigs.at(paper), rigs.at(ours),
                               {"landmarks.backend", "projector.", "twin.", "camera.", "pose."}),
                testing::IsEmpty())
        << paper;
    EXPECT_THAT(differences_in(rigs.at(paper), shipped("paper"), {"cascade."}), testing::IsEmpty());
    EXPECT_THAT(differences_in(rigs.at(ours), shipped("twin"), {"cascade."}), testing::IsEmpty());
  }
  EXPECT_THAT(
      differences_in(rigs.at("paper"), shipped("paper"),
                     {"cascade.", "landmarks.", "projector.", "twin.projector.", "twin.detector."}),
      testing::IsEmpty())
      << "as published";
}

/// What each row of the levers changes in the row above it.
const std::vector<std::pair<std::string, std::vector<std::string>>> kLevers{
    {"paper", {}},
    {"bone_fit", {"cascade.skin.fit"}},
    {"widths", {"cascade.skin.widths"}},
    {"vertices",
     {"cascade.correct.method", "cascade.correct.alpha", "cascade.mask.advance",
      "cascade.fill.reach_px", "cascade.fill.fade_px"}},
    {"registration", {"cascade.register.method", "cascade.ladder.rung", "cascade.filter.blend_ms"}},
    {"network", {"landmarks.backend", "twin.detector.age_ms", "twin.detector.age_sd_ms"}},
    {"estimate", {"cascade.filter.method"}},
    {"outline", {"cascade.correct.outline"}},
    {"prediction",
     {"cascade.predict.method", "cascade.predict.still_mm_s",
      // What takes the network's place without its files, which is no lever.
      "landmarks.fallback"}},
};

TEST(ShippedPlans, EachLeverAddsWhatItIsNamedAfterAndTheLastRowIsOurs) {
  const auto rigs = rigs_of("levers");
  ASSERT_EQ(rigs.size(), kLevers.size());
  const std::vector<std::string> everything{"cascade.", "landmarks.", "projector.", "twin.",
                                            "camera.",  "pose.",      "content.",   "hand."};
  EXPECT_THAT(differences_in(rigs.front().second, shipped("paper"), {"cascade.", "landmarks."}),
              testing::IsEmpty());
  for (std::size_t i = 0; i < rigs.size(); ++i) {
    EXPECT_EQ(rigs[i].first, kLevers[i].first);
    if (i == 0) continue;
    EXPECT_THAT(differences_in(rigs[i].second, rigs[i - 1].second, everything),
                testing::UnorderedElementsAreArray(kLevers[i].second))
        << rigs[i].first;
  }
  EXPECT_THAT(
      differences_in(rigs.back().second, shipped("twin"),
                     {"cascade.", "landmarks.", "projector.", "twin.detector.", "twin.projector."}),
      testing::IsEmpty());
}

TEST(ShippedPlans, TheUnseenMotionsAreScoredWithTheRigsOfTheComparison) {
  std::map<std::string, config::Rig> compared;
  for (const auto& [name, rig] : rigs_of("comparison")) compared.emplace(name, rig);
  const auto unseen = rigs_of("unseen");
  EXPECT_EQ(unseen.size(), 6u);
  for (const auto& [name, rig] : unseen)
    EXPECT_THAT(config::differences(rig, compared.at(name)), testing::ElementsAre("twin.motion"))
        << name;
}

TEST(ShippedPlans, TheBenchmarkHasTheRigsOfTheComparison) {
  std::map<std::string, config::Rig> compared;
  for (const auto& [name, rig] : rigs_of("comparison")) compared.emplace(name, rig);
  compared.emplace("paper_at_our_speed", compared.at("paper_network"));
  for (const auto* plan : {"benchmark", "benchmark_stress"}) {
    const auto rigs = rigs_of(plan);
    EXPECT_EQ(rigs.size(), 4u) << plan;
    for (const auto& [name, rig] : rigs) {
      auto others = config::differences(rig, compared.at(name));
      std::erase(others, "twin.tracker.age_ms");  // the first stress
      EXPECT_THAT(others, testing::UnorderedElementsAre("twin.motion", "twin.seed"))
          << plan << ' ' << name;
    }
  }
}

/// The seeds of a plan, as in its file.
std::set<int> people_of(const std::filesystem::path& file) {
  const auto plan = load_plan(file);
  EXPECT_TRUE(plan) << plan.error().what;
  std::set<int> people;
  const auto expansion = expand(*plan);
  for (const auto& run : expansion->runs) people.insert(rig_of(*plan, run)->twin.seed);
  return people;
}

TEST(ShippedPlans, NoOtherPlanHasAPersonOfTheBenchmark) {
  constexpr int kFirst = 101;
  int plans = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_root() / "config/sweeps")) {
    if (!entry.is_regular_file()) continue;
    ++plans;
    const auto people = people_of(entry.path());
    if (entry.path().stem().string().starts_with("benchmark"))
      EXPECT_GE(*people.begin(), kFirst) << entry.path();
    else
      EXPECT_LT(*people.rbegin(), kFirst - 1) << entry.path();
  }
  EXPECT_GT(plans, 15);
}

TEST(ShippedPlans, JitterFirstSecondsAndLaterAreOfTheRigsOfTheComparison) {
  std::map<std::string, config::Rig> compared;
  for (const auto& [name, rig] : rigs_of("comparison")) compared.emplace(name, rig);
  for (const auto& [plan, variants] :
       {std::pair("jitter", 5u), std::pair("first_seconds", 3u), std::pair("later", 3u)}) {
    const auto rigs = rigs_of(plan);
    EXPECT_EQ(rigs.size(), variants) << plan;
    for (const auto& [name, rig] : rigs)
      EXPECT_THAT(config::differences(rig, compared.at(name)), testing::IsEmpty())
          << plan << ' ' << name;
  }
}

TEST(ShippedPlans, FirstSecondsAndLaterBeginWhenTheirTablesSay) {
  for (const auto& [name, warm_up_s] : {std::pair("first_seconds", 0), std::pair("later", 20)}) {
    const auto plan = load_plan(source_root() / "config/sweeps" / (std::string(name) + ".toml"));
    ASSERT_TRUE(plan) << plan.error().what;
    EXPECT_EQ(plan->warm_up_s, warm_up_s);
  }
}

/// The values of a setting in the grid of a shipped plan.
std::set<std::string> values_in(const std::string& plan_name, const std::string& setting) {
  const auto plan = load_plan(source_root() / "config/sweeps" / (plan_name + ".toml"));
  EXPECT_TRUE(plan) << plan.error().what;
  const auto expansion = expand(*plan);
  std::set<std::string> values;
  for (const auto& run : expansion->runs) {
    const auto rig = rig_of(*plan, run);
    values.insert(setting == "motion" ? rig->twin.motion : rig->twin.shape.mesh);
  }
  return values;
}

TEST(ShippedPlans, TheTablesOfAccuracyAreOfACarefulInstallation) {
  const auto careful = rigs_of("comparison").front().second;
  for (const auto* name : {"levers", "fidelity", "motions", "fast", "two_hands", "jitter",
                           "first_seconds", "later", "unseen", "hardware"})
    for (const auto& [variant, rig] : rigs_of(name)) {
      EXPECT_EQ(rig.twin.shape.roll_deg, careful.twin.shape.roll_deg) << name << " " << variant;
      auto others =
          differences_in(rig, careful, {"twin.geometry.", "twin.tracker.", "twin.image."});
      if (name == std::string_view("hardware")) std::erase(others, "twin.image.delivery_ms");
      EXPECT_THAT(others, testing::IsEmpty()) << name << " " << variant;
    }
}

/// The settings that make a camera or a projector in hardware.toml.
const std::vector<std::string> kOfDevices{
    "camera.rate_hz",        "camera.exposure_ms",      "twin.image.delivery_ms",
    "twin.detector.age_ms",  "projector.rate_hz",       "projector.latency_ms",
    "projector.software_ms", "twin.projector.rate_ppm", "cascade.predict.limit_ms"};

TEST(ShippedPlans, HardwareDiffersFromTheUnseenInDevicesAlone) {
  std::map<std::string, config::Rig> unseen;
  for (const auto& [name, rig] : rigs_of("unseen")) unseen.emplace(name, rig);
  const auto rigs = rigs_of("hardware");
  EXPECT_EQ(rigs.size(), 10u);
  for (const auto& [name, rig] : rigs) {
    auto others = config::differences(rig, unseen.at(name.substr(0, name.find('_'))));
    std::erase_if(others,
                  [](const std::string& path) { return std::ranges::count(kOfDevices, path); });
    EXPECT_THAT(others, testing::IsEmpty()) << name;
  }
}

TEST(ShippedPlans, OtherPartsAreComparedWithAPairOfHardware) {
  std::map<std::string, config::Rig> pairs;
  for (const auto& [name, rig] : rigs_of("hardware")) pairs.emplace(name, rig);
  const auto parts = rigs_of("hardware_parts");
  ASSERT_EQ(parts.size(), 6u);
  EXPECT_EQ(parts.front().first, "usual");
  EXPECT_THAT(config::differences(parts.front().second, pairs.at("handcast_120")),
              testing::UnorderedElementsAre("projector.rate_hz", "projector.latency_ms"));
  EXPECT_EQ(parts.front().second.projector.rate_hz, 120);
}

TEST(ShippedPlans, NoDeviceOfHardwareIsFasterThanItsRatePermits) {
  const auto plan = load_plan(source_root() / "config/sweeps/hardware.toml");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto expansion = expand(*plan);
  ASSERT_TRUE(expansion) << expansion.error().what;
  std::set<std::pair<double, double>> pairs;
  for (const auto& run : expansion->runs) {
    const auto rig = rig_of(*plan, run);
    const auto& camera = rig->camera;
    EXPECT_EQ(plan->variants[run.variant].name.substr(rig->name == "paper" ? 6 : 9),
              fmt::format("{}", camera.rate_hz));
    EXPECT_LT(camera.exposure_ms, 1e3 / camera.rate_hz);
    // What a detector takes is the same with all cameras.
    EXPECT_NEAR(rig->twin.detector.age_ms - camera.exposure_ms / 2 - rig->twin.image.delivery_ms,
                rig->name == "paper" ? 15 : 3.8, 0.05);
    pairs.emplace(camera.rate_hz, rig->projector.rate_hz);
  }
  EXPECT_EQ(pairs.size(), 20u);
}

TEST(ShippedPlans, TheBenchmarksOwnMotionsAreUnseenOnes) {
  const auto unseen = values_in("unseen", "motion");
  for (const auto* plan : {"benchmark", "benchmark_stress"})
    for (const auto& motion : values_in(plan, "motion"))
      EXPECT_TRUE(unseen.contains(motion) || !motion.starts_with("builtin:")) << motion;
}

TEST(ShippedPlans, TheUnseenMotionsAreInNoOtherPlan) {
  const auto unseen = values_in("unseen", "motion");
  EXPECT_EQ(unseen.size(), 5u);
  EXPECT_EQ(values_in("unseen", "mesh"), (std::set<std::string>{"implicit", "webxr"}));
  for (const auto& file : std::filesystem::directory_iterator(source_root() / "config/sweeps")) {
    const auto name = file.path().stem().string();
    // Nothing is chosen on the benchmark, hardware.toml and hardware_parts.toml either.
    if (file.path().extension() != ".toml" || name == "unseen" || name.starts_with("hardware") ||
        name.starts_with("benchmark"))
      continue;
    for (const auto& motion : values_in(name, "motion"))
      EXPECT_FALSE(unseen.contains(motion)) << name << ": " << motion;
  }
}

}  // namespace
}  // namespace handcast::sweep
