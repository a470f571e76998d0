// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <map>

#include "tests/config/every_setting.hpp"
#include "tests/services/evaluation/sweep/plans.hpp"

/// Tests of the plans in config/sweeps.
namespace handcast::sweep {
namespace {

using testing::IsSubsetOf;

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

TEST(ShippedPlans, TheLeversLeadFromThePapersCascadeToOursStepByStep) {
  const auto rigs = rigs_of("levers");
  ASSERT_GT(rigs.size(), 2u);
  EXPECT_THAT(differences_in(rigs.front().second, shipped("paper"), {"cascade.", "landmarks."}),
              testing::IsEmpty());
  EXPECT_THAT(differences_in(
                  rigs.back().second, shipped("twin"),
                  {"cascade.", "landmarks.", "projector.", "twin.detector.age", "twin.projector."}),
              testing::IsEmpty());
  for (std::size_t i = 1; i < rigs.size(); ++i)
    EXPECT_THAT(differences_in(rigs[i].second, rigs[i - 1].second, {"cascade.", "landmarks."}),
                Not(testing::IsEmpty()))
        << rigs[i].first << " brings nothing";
  EXPECT_THAT(
      differences_in(rigs.back().second, rigs[rigs.size() - 2].second, {"cascade."}),
      IsSubsetOf({"cascade.ladder.rung", "cascade.predict.method", "cascade.predict.still_mm_s"}))
      << "the gate alone";
}

}  // namespace
}  // namespace handcast::sweep
