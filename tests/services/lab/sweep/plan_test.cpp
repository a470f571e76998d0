// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "tests/services/lab/sweep/plans.hpp"
#include "tests/system/variable.hpp"

namespace handcast::sweep {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kTwoByTwo = R"(
[settings]
twin.tracker.age_ms = 15
[[variant]]
name = "ours"
[[variant]]
name = "still"
settings.cascade.filter.method = "paper"
[variant.settings.cascade.predict]
method = "hold"
[grid]
"twin.motion" = ["builtin:wave", "builtin:still"]
twin.speed = [1, 2.5, 3]
)";

TEST(Plan, RunsVariantByVariantWithTheLastAxisTurningFastest) {
  const auto plan = plan_of(kTwoByTwo);
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  ASSERT_EQ(runs.size(), 12u);
  EXPECT_EQ(describe_run(*plan, runs[0]), "ours, twin.motion=builtin:wave, twin.speed=1");
  EXPECT_EQ(describe_run(*plan, runs[1]), "ours, twin.motion=builtin:wave, twin.speed=2.5");
  EXPECT_EQ(describe_run(*plan, runs[3]), "ours, twin.motion=builtin:still, twin.speed=1");
  EXPECT_EQ(describe_run(*plan, runs[11]), "still, twin.motion=builtin:still, twin.speed=3");
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i].index, i);
}

TEST(Plan, ARunHasTheSettingsOfThePlanItsVariantAndItsPlaceInTheGrid) {
  const auto plan = plan_of(kTwoByTwo);
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  const auto rig = rig_of(*plan, runs[10]);
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->twin.tracker.age_ms, 15);
  EXPECT_EQ(rig->cascade.filter.method, config::FilterMethod::paper);
  EXPECT_EQ(rig->cascade.predict.method, config::PredictMethod::hold);
  EXPECT_EQ(rig->twin.motion, "builtin:still");
  EXPECT_EQ(rig->twin.speed, 2.5);
  EXPECT_EQ(rig_of(*plan, runs[0])->cascade.filter.method, config::Rig().cascade.filter.method);
}

TEST(Plan, WithoutARigIsToldSoAndNotOfAFileThatItDoesNotName) {
  for (const auto* toml : {"seconds = 1\n", "[[variant]]\nname = \"a\"\n"}) {
    const auto plan = parse_plan(toml, "/plans/test.toml");
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().what,
              "/plans/test.toml:1: rig: is missing, and there is no ../rigs/twin.toml, which is "
              "read in its place; write the path of a rig file, relative to the plan");
  }
  const auto other = parse_plan("rig = \"../rigs/twin.toml\"\n", "/plans/test.toml");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr("rig: /rigs/twin.toml: cannot be read"));
}

TEST(Plan, AVariantHasTheSettingsOfThoseItIsFrom) {
  const auto plan = plan_of(
      "[[variant]]\nname = \"still\"\nsettings.twin.motion = \"builtin:still\"\n"
      "settings.twin.speed = 2\n"
      "[[variant]]\nname = \"paper\"\nrig = \"" +
      (source_root() / "config/rigs/paper.toml").string() +
      "\"\nsettings.cascade.skin.fit = true\n"
      "[[variant]]\nname = \"both\"\nfrom = [\"paper\", \"still\"]\nsettings.twin.speed = 3\n"
      "[[variant]]\nname = \"still_again\"\nfrom = [\"still\", \"both\"]\nrig = \"" +
      (source_root() / "config/rigs/baseline.toml").string() + "\"\n");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  const auto both = rig_of(*plan, runs[2]);
  ASSERT_TRUE(both) << both.error().what;
  EXPECT_EQ(both->cascade.filter.method, config::FilterMethod::paper) << "the rig of the first";
  EXPECT_TRUE(both->cascade.skin.fit);
  EXPECT_EQ(both->twin.motion, "builtin:still");
  EXPECT_EQ(both->twin.speed, 3) << "its own";
  EXPECT_EQ(plan->variants[3].rig_file.filename(), "baseline.toml") << "its own";
  EXPECT_EQ(rig_of(*plan, runs[3])->twin.speed, 3) << "the last counts";
}

TEST(Plan, AVariantHasEachSettingOnce) {
  std::string toml = "[[variant]]\nname = \"v0\"\nsettings.twin.speed = 2\n";
  for (int i = 1; i < 40; ++i)
    toml += fmt::format("[[variant]]\nname = \"v{0}\"\nfrom = [\"v{1}\", \"v{1}\"]\n", i, i - 1);
  const auto plan = plan_of(toml);
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->variants.back().settings.size(), 1u);
}

TEST(Plan, AVariantIsOnlyFromThoseAbove) {
  EXPECT_THAT(fault_of("[[variant]]\nname = \"a\"\nfrom = [\"b\"]\n[[variant]]\nname = \"b\"\n"),
              HasSubstr(":2: variant.from: no variant above is called 'b'"));
}

TEST(Plan, WithoutVariantsAndGridItIsOneRunOfItsRig) {
  const auto plan = plan_of("seconds = 2\njoints_only = true\n");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->draw_every, 0);
  EXPECT_EQ(plan->seconds, 2);
  ASSERT_EQ(expand(*plan)->runs.size(), 1u);
  EXPECT_EQ(describe_run(*plan, expand(*plan)->runs[0]), "twin");
}

TEST(Plan, SharesSettingsWithOtherPlansAndItsOwnCountMore) {
  const test::Scratch folder;
  write_text(folder.path() / "world.toml", "twin.tracker.age_ms = 20\n[twin.image]\nlost = 0.5\n");
  const auto plan = plan_of(
      "settings_from = \"world.toml\"\n[settings]\ntwin.image.lost = 0.25\n[[variant]]\nname = "
      "\"a\"\n[[variant]]\nname = \"b\"\nsettings.twin.tracker.age_ms = 30\n",
      folder.path() / "plan.toml");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  const auto a = rig_of(*plan, runs[0]), b = rig_of(*plan, runs[1]);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->twin.tracker.age_ms, 20);
  EXPECT_EQ(a->twin.image.lost, 0.25);
  EXPECT_EQ(b->twin.tracker.age_ms, 30);
}

TEST(Plan, AnAxisCountsMoreThanASharedSettingButCannotBeFixedInThePlanToo) {
  const test::Scratch folder;
  write_text(folder.path() / "world.toml", "twin.tracker.age_ms = 20\n");
  const std::string head = "settings_from = \"world.toml\"\n",
                    grids = "[[grid]]\ntwin.tracker.age_ms = [5]\n[[grid]]\ntwin.speed = [2]\n";
  const auto plan = plan_of(head + grids, folder.path() / "plan.toml");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  EXPECT_EQ(rig_of(*plan, runs[0])->twin.tracker.age_ms, 5);
  EXPECT_EQ(rig_of(*plan, runs[1])->twin.tracker.age_ms, 20) << "an axis of another grid";
  const auto twice =
      plan_of(head + "[settings]\ntwin.tracker.age_ms = 30\n" + grids, folder.path() / "plan.toml");
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().what, HasSubstr("is fixed here"));
}

TEST(Plan, AWrongSharedSettingIsNamedWithItsOwnFileAndLine) {
  const test::Scratch folder;
  write_text(folder.path() / "world.toml", "# a comment\ntwin.tracker.age_ms = -1\n");
  const auto with = [&](const std::string& file) {
    const auto plan = plan_of("settings_from = \"" + file + "\"\n", folder.path() / "plan.toml");
    return plan ? "" : plan.error().what;
  };
  EXPECT_THAT(with("world.toml"), HasSubstr("world.toml:2: "));
  EXPECT_THAT(with("nowhere.toml"), HasSubstr((folder.path() / "nowhere.toml").string()));
}

TEST(Plan, AHandsMeshIsAFileOfThePlansFolderOrAWord) {
  for (const auto& [written, read] : {std::pair{"webxr", "webxr"}, {"my.glb", "/plans/my.glb"}}) {
    const auto plan = plan_of(fmt::format("[grid]\ntwin.shape.mesh = [\"{}\"]\n", written));
    ASSERT_TRUE(plan) << plan.error().what;
    EXPECT_EQ(rig_of(*plan, expand(*plan)->runs[0])->twin.shape.mesh, read);
  }
}

TEST(Plan, AListOfTextsKeepsItsQuotes) {
  const auto plan = plan_of("[settings]\ncamera.v4l2.controls = [\"gain=1\", \"exposure=2\"]\n");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto expansion = expand(*plan);
  ASSERT_TRUE(expansion) << expansion.error().what;
  const auto rig = rig_of(*plan, expansion->runs[0]);
  ASSERT_TRUE(rig) << rig.error().what;
  EXPECT_THAT(rig->camera.v4l2.controls, ElementsAre("gain=1", "exposure=2"));
}

TEST(Plan, EmptyListsAndPathsWithoutEndAreRefused) {
  std::string deep = "a";
  for (int i = 0; i < 100'000; ++i) deep += ".a";
  for (const auto& [text, why] : {std::pair{std::string("grid = []\n"), "nothing to run"},
                                  {"variant = []\n", "nothing to run"},
                                  {"[settings]\n\"" + deep + "\" = 1\n", "no such setting"}}) {
    const auto plan = plan_of(text);
    ASSERT_FALSE(plan);
    EXPECT_THAT(plan.error().what, HasSubstr(why));
  }
}

TEST(Plan, SeveralGridsAreRunOneAfterTheOther) {
  const auto plan = plan_of(
      "[[grid]]\ntwin.tracker.age_ms = [5, 40]\n[[grid]]\ntwin.speed = [2]\ntwin.tracker.dropout = "
      "[0.1, 0.2]\n");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  ASSERT_EQ(runs.size(), 4u) << "not every combination of both";
  EXPECT_EQ(describe_run(*plan, runs[1]), "twin, twin.tracker.age_ms=40");
  EXPECT_EQ(describe_run(*plan, runs[3]), "twin, twin.speed=2, twin.tracker.dropout=0.2");
  EXPECT_EQ(rig_of(*plan, runs[3])->twin.tracker.age_ms, config::Rig().twin.tracker.age_ms);
  EXPECT_THAT(plan->axes(),
              ElementsAre("twin.tracker.age_ms", "twin.speed", "twin.tracker.dropout"));
  const auto row = failed_row(*plan, runs[3], "");
  EXPECT_THAT(Row(row.begin(), row.begin() + 5), ElementsAre("3", "twin", "", "2", "0.2"))
      << "an axis of another grid must be empty";
  EXPECT_EQ(row.size(), heading_of(*plan, *expand(*plan), "1").columns.size());
}

TEST(Plan, ASettingIsNotFixedWhereAnyGridTurnsIt) {
  EXPECT_THAT(
      fault_of(
          "[settings]\ntwin.speed = 2\n[[grid]]\ntwin.seed = [1]\n[[grid]]\ntwin.speed = [1, 2]\n"),
      HasSubstr("is also an axis of a grid"));
}

TEST(Plan, FoldersAreRelativeToThePlan) {
  const auto plan = plan_of("[grid]\ntwin.motion = [\"../data/wave\", \"builtin:wave\"]\n",
                            "/plans/deep/test.toml");
  ASSERT_TRUE(plan) << plan.error().what;
  EXPECT_EQ(plan->grids[0][0].choices[0].assigned, "/plans/data/wave");
  EXPECT_EQ(plan->grids[0][0].choices[0].shown, "../data/wave");
  EXPECT_EQ(plan->grids[0][0].choices[1].assigned, "builtin:wave");
}

TEST(Plan, AMotionThatIsNotThereIsNoFaultOfThePlanButNamed) {
  const auto plan = plan_of("[grid]\ntwin.motion = [\"nowhere\", \"builtin:wave\"]\n");
  ASSERT_TRUE(plan) << plan.error().what;
  const auto runs = expand(*plan)->runs;
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_THAT(why_absent(*rig_of(*plan, runs[0])).value_or(""), HasSubstr("/plans/nowhere"));
  EXPECT_FALSE(why_absent(*rig_of(*plan, runs[1])));
}

TEST(Plan, EveryFaultIsNamedWithItsLineAtOnce) {
  const auto fault = fault_of(
      "secnds = 3\n"                                          // line 2, after the rig
      "[settings]\n"                                          //
      "cascade.filter.methd = \"paper\"\n"                    // 4
      "[[variant]]\n"                                         //
      "name = \"a\"\n"                                        //
      "[[variant]]\n"                                         // 7
      "name = \"a\"\n"                                        //
      "settings.projector.rate_hz = \"fast\"\n"               // 9
      "[grid]\n"                                              //
      "twin.speed = 2\n"                                      // 11
      "twin.seed = [1,\n"                                     //
      "  -4]\n"                                               // 13
      "cascade.filter.method = [\"paper\", \"kallman\"]\n");  // 14
  EXPECT_THAT(
      fault,
      HasSubstr("/plans/test.toml:2: secnds: there is no such setting (did you mean 'seconds'?)"));
  EXPECT_THAT(
      fault,
      HasSubstr(":4: cascade.filter.methd: there is no such setting (did you mean 'method'?)"));
  EXPECT_THAT(fault, HasSubstr(":7: variant.name: two variants are called 'a'"));
  EXPECT_THAT(fault, HasSubstr(":9: projector.rate_hz: must be a number"));
  EXPECT_THAT(fault, HasSubstr(":11: twin.speed: must be a list"));
  EXPECT_THAT(fault, HasSubstr(":13: twin.seed: -4 is outside"));
  EXPECT_THAT(fault, HasSubstr(":14: cascade.filter.method: 'kallman' is not"));
}

TEST(Plan, ASectionsNameThatIsMistypedIsSuggested) {
  EXPECT_THAT(fault_of("[gird]\nx = [1]\n"), HasSubstr("did you mean 'grid'?"));
}

TEST(Plan, ASettingThatIsBothFixedAndInTheGridIsAFault) {
  EXPECT_THAT(fault_of("[settings]\ntwin.speed = 2\n[grid]\ntwin.speed = [1, 2]\n"),
              HasSubstr(":3: twin.speed: is fixed here"));
}

TEST(Plan, SettingsThatDoNotGoTogetherAreNamedByTheFirstRunTheyAreIn) {
  const auto fault =
      fault_of("[grid]\ncascade.correct.bone_long_px = [24, 4]\ntwin.seed = [1, 2]\n");
  EXPECT_THAT(fault, HasSubstr("run 2 (twin, cascade.correct.bone_long_px=4, twin.seed=1)"));
  EXPECT_THAT(fault, testing::Not(HasSubstr("run 3")));
}

TEST(Plan, ARigThatIsNotThereIsAFault) {
  EXPECT_THAT(fault_of("rig = \"nowhere.toml\"\n"), HasSubstr("rig: /plans/nowhere.toml"));
}

TEST(Fingerprint, IsTheSameOnlyWhereEveryRunIs) {
  const auto fingerprint = fingerprint_of(kTwoByTwo);
  EXPECT_EQ(fingerprint, fingerprint_of(kTwoByTwo)) << "nothing changed";
  std::set<std::string> all{fingerprint};
  const std::string text = kTwoByTwo;
  const auto changed = [&](const std::string& from, const std::string& to) {
    auto other = text;
    all.insert(fingerprint_of(other.replace(other.find(from), from.size(), to)));
  };
  changed("[settings]", "seconds = 7\n[settings]");
  changed("[settings]", "joints_only = true\n[settings]");
  changed("[settings]", "draw_hz = 30\n[settings]");
  changed("age_ms = 15", "age_ms = 16");
  changed("name = \"still\"", "name = \"calm\"");
  changed("2.5, 3", "3, 2.5");
  EXPECT_EQ(all.size(), 7u);
}

TEST(Fingerprint, ChangesWithTheRigFile) {
  const test::Scratch scratch;
  write_text(scratch.path() / "rig.toml", "name = \"a\"\n");
  const auto before = fingerprint_of("rig = \"rig.toml\"\n", scratch.path() / "plan.toml");
  write_text(scratch.path() / "rig.toml", "name = \"a\"\nprojector.rate_hz = 500\n");
  EXPECT_NE(before, fingerprint_of("rig = \"rig.toml\"\n", scratch.path() / "plan.toml"));
}

TEST(Fingerprint, ChangesWithTheFilesThatTheRigNames) {
  const test::Scratch scratch;
  write_text(scratch.path() / "rig.toml", "calibration = \"rig.cal\"\n");
  write_text(scratch.path() / "rig.cal", "one");
  const auto before = fingerprint_of("rig = \"rig.toml\"\n", scratch.path() / "plan.toml");
  write_text(scratch.path() / "rig.cal", "another");
  EXPECT_NE(before, fingerprint_of("rig = \"rig.toml\"\n", scratch.path() / "plan.toml"));
}

TEST(Fingerprint, ChangesWithTheNetworksAndWithTheHandThatNoSettingNames) {
  const test::Scratch scratch;
  const auto models = scratch.path() / "models";
  std::filesystem::create_directory(models);
  write_text(scratch.path() / "rig.toml",
             "[landmarks]\nbackend = \"mediapipe\"\nfallback = \"twin\"\nmodels = \"models\"\n"
             "[twin.shape]\nmesh = \"webxr\"\n");
  const system_test::Variable hand("HANDCAST_WEBXR_HAND", (scratch.path() / "hand.glb").string());
  std::set<std::string> all;
  const auto add = [&] {
    all.insert(fingerprint_of("rig = \"rig.toml\"\n", scratch.path() / "plan.toml"));
  };
  add();  // the fallback
  for (const char* file : {"hand_landmark_lite.onnx", "palm_detection_lite.onnx"})
    write_text(models / file, "one");
  add();
  write_text(models / "hand_landmark_lite.onnx", "another");
  add();
  write_text(models / "palm_detection_lite.onnx", "another");
  add();
  for (const char* content : {"one", "another"}) {
    write_text(scratch.path() / "hand.glb", content);
    add();
  }
  EXPECT_EQ(all.size(), 6u);
}

TEST(Fingerprint, IsTheSameWhereverThePlanLies) {
  const test::Scratch here, there;
  for (const auto* folder : {&here, &there})
    write_text(folder->path() / "rig.toml", "calibration = \"rig.cal\"\n");
  const std::string plan = "rig = \"rig.toml\"\n[grid]\ntwin.motion = [\"data/wave\"]\n";
  EXPECT_EQ(fingerprint_of(plan, here.path() / "plan.toml"),
            fingerprint_of(plan, there.path() / "plan.toml"));
}

TEST(Shards, TogetherAreEveryRunOnce) {
  const auto plan = plan_of(kTwoByTwo);
  ASSERT_TRUE(plan);
  const auto runs = expand(*plan)->runs;
  for (const auto& run : runs) {
    int owners = 0;
    for (std::size_t i = 0; i < 5; ++i) owners += Shard{i, 5}.has(run);
    EXPECT_EQ(owners, 1);
  }
}

TEST(Shards, AreWrittenAsIndexAndCount) {
  const auto shard = parse_shard("2/8");
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->index, 2u);
  EXPECT_EQ(shard->count, 8u);
  for (const char* wrong : {"", "2", "2/", "/8", "8/8", "0/0", "1/2/3", "-1/4", "a/b"})
    EXPECT_FALSE(parse_shard(wrong)) << wrong;
}

TEST(ShippedPlans, AreWithoutFault) {
  for (const char* name :
       {"causes", "comparison", "detectors", "failures", "fast", "fidelity", "filters", "jitter",
        "ladder", "levers", "motions", "no_tracker", "stress", "times", "two_hands", "unseen"}) {
    const auto plan = load_plan(source_root() / "config/sweeps" / (std::string(name) + ".toml"));
    ASSERT_TRUE(plan) << plan.error().what;
    const auto expansion = expand(*plan);
    EXPECT_TRUE(expansion) << expansion.error().what;
  }
}

}  // namespace
}  // namespace handcast::sweep
