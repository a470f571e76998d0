// SPDX-License-Identifier: Apache-2.0
#include "services/studies/pose/pose.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "renderer/media/picture.hpp"
#include "services/studies/pose/game.hpp"
#include "services/studies/pose/picture.hpp"
#include "services/studies/pose/run.hpp"
#include "services/studies/pose/sessions.hpp"
#include "tests/scratch.hpp"
#include "tests/services/studies/scripted_hand.hpp"

namespace handcast::study {
namespace {

void hold(PoseGame& game, const HeldPose* held, double seconds) {
  const auto steps = static_cast<int>(std::ceil(seconds / kStep_s));
  for (int step = 0; step < steps; ++step) game.step(kStep_s, held);
}

TEST(Poses, AreTheSameWhereverTheHandIsAndForBothHands) {
  const auto pose = builtin_poses()[3];
  std::array<glm::vec3, msg::kJoints> moved{}, mirrored{};
  const glm::mat4 way = glm::translate(
      glm::rotate(glm::mat4(1), 1.1f, glm::normalize(glm::vec3(1, 2, -1))), {0.2f, -0.1f, 0.6f});
  for (std::size_t joint = 0; joint < msg::kJoints; ++joint) {
    const glm::vec3 at = 1e-3f * pose.joints_mm[joint];
    moved[joint] = glm::vec3(way * glm::vec4(at, 1));
    mirrored[joint] = {-at.x, at.y, at.z};
  }
  EXPECT_GT(score_of(pose, held_pose(moved, msg::Side::left)).worst_finger, 0.999f);
  EXPECT_GT(score_of(pose, held_pose(mirrored, msg::Side::right)).worst_finger, 0.999f);
}

TEST(Poses, EveryOneOfTheNineIsOnlyItself) {
  const auto poses = builtin_poses();
  ASSERT_EQ(poses.size(), 9u);
  for (std::size_t a = 0; a < poses.size(); ++a)
    for (std::size_t b = 0; b < poses.size(); ++b) {
      if (a == b) continue;
      EXPECT_LT(score_of(poses[a], poses[b]).worst_finger, PoseGame::kDone)
          << poses[a].name << " is taken for " << poses[b].name;
    }
}

TEST(Poses, AScoreIsOneMinusTheAngleByPi) {
  const auto pose = builtin_poses()[0];
  auto bent = pose;
  // The last bone of the index finger is turned by a right angle.
  const glm::vec3 bone = pose.joints_mm[10] - pose.joints_mm[9];
  const glm::vec3 across = glm::normalize(glm::cross(bone, glm::vec3(1, 0.3f, 0)));
  bent.joints_mm[10] = bent.joints_mm[9] + glm::length(bone) * across;
  const auto score = score_of(pose, bent);
  EXPECT_NEAR(score.bones[5], 0.5f, 1e-4);
  EXPECT_NEAR(score.worst_finger, 2.5f / 3, 1e-4);
  EXPECT_NEAR(score.bones[4], 1, 1e-4);
}

TEST(PoseGame, EachPoseIsMatchedOnceAndHeldForHalfASecond) {
  const auto poses = builtin_poses();
  PoseGame game(poses, 3);
  std::set<std::string> names;
  while (const auto* wanted = game.wanted()) {
    const HeldPose pose = *wanted;
    const auto before = game.matched().size();
    hold(game, &pose, 0.4);
    ASSERT_EQ(game.matched().size(), before);
    hold(game, &pose, 0.15);
    ASSERT_EQ(game.matched().size(), before + 1);
    names.insert(pose.name);
  }
  EXPECT_EQ(names.size(), 9u);
}

TEST(PoseGame, TimeWithoutAHandDoesNotCountAndEndsTheHold) {
  PoseGame game(builtin_poses(), 3);
  const HeldPose pose = *game.wanted();
  hold(game, &pose, 0.4);
  hold(game, nullptr, 20);
  EXPECT_FALSE(game.score());
  hold(game, &pose, 0.4);
  EXPECT_TRUE(game.matched().empty());
  hold(game, &pose, 0.2);
  ASSERT_EQ(game.matched().size(), 1u);
  EXPECT_NEAR(game.matched()[0].seconds, 0.95, 0.1);
}

TEST(RangeOfMotion, IsThatOfMostOfTheSession) {
  const auto poses = builtin_poses();
  RangeOfMotion motion;
  EXPECT_FALSE(motion.ranges());
  for (int i = 0; i < 100; ++i) motion.see(poses[static_cast<std::size_t>(i % 2)]);  // open, fist
  const auto open = flexions_deg(poses[0]), fist = flexions_deg(poses[1]);
  const auto before = motion.ranges();
  ASSERT_TRUE(before);
  EXPECT_NEAR((*before)[3].least_deg, std::min(open[3], fist[3]), 1);
  EXPECT_NEAR((*before)[3].most_deg, std::max(open[3], fist[3]), 1);
  EXPECT_GT((*before)[3].most_deg - (*before)[3].least_deg, 60) << flexion_name(3);
  auto jump = poses[0];
  jump.joints_mm[9] = jump.joints_mm[7];
  motion.see(jump);
  EXPECT_FLOAT_EQ((*motion.ranges())[3].most_deg, (*before)[3].most_deg);
}

TEST(TaughtPoses, ComeBackFromTheirFile) {
  const test::Scratch scratch;
  const auto file = scratch.path() / "my.csv";
  for (const auto& pose : builtin_poses()) ASSERT_TRUE(add_pose(file, pose));
  // An editor may have left the last line without an end.
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  ASSERT_TRUE(add_pose(file, builtin_poses()[0]));
  const auto poses = read_poses(file);
  ASSERT_TRUE(poses) << poses.error().what;
  ASSERT_EQ(poses->size(), 10u);
  EXPECT_GT(score_of(builtin_poses()[2], (*poses)[2]).worst_finger, 0.99f);
  std::ofstream(file) << "name,x\na,1\n";
  EXPECT_THAT(read_poses(file).error().what, testing::HasSubstr("no poses"));
}

TEST(PoseReport, HasTheSessionsAndTheRangeOfEachJoint) {
  StudyTable log{.name = "log",
                 .columns = pose_columns(),
                 .rows = {{"7", "monday", "pose", "fist", "4.5", ""},
                          {"7", "monday", "range", "index PIP", "5", "60"},
                          {"7", "friday", "pose", "fist", "3.5", ""},
                          {"7", "friday", "range", "index PIP", "5", "85"}}};
  const auto page = pose_report({log});
  ASSERT_TRUE(page) << page.error().what;
  EXPECT_THAT(*page, testing::HasSubstr("Person 7"));
  EXPECT_THAT(*page, testing::HasSubstr("index PIP<td>5°…60°<td>5°…85°<td>+25°"));
  log.rows[1][4] = "wide";
  EXPECT_FALSE(pose_report({log}));
  log.columns = {"a"};
  EXPECT_FALSE(pose_report({log}));
}

/// A log of so many sessions, in which the joints bend farther each time.
StudyTable log_of_sessions(int count) {
  StudyTable log{.name = "log", .columns = pose_columns(), .rows = {}};
  for (int s = 0; s < count; ++s) {
    const auto time = fmt::format("2026-11-{:02}T09:{:02}:05Z", 1 + s / 2, s);
    log.rows.push_back({"7", time, "pose", "fist", fmt::format("{}", 9.5 - 0.2 * s), ""});
    for (std::size_t joint = 0; joint < kFlexions; ++joint)
      log.rows.push_back({"7", time, "range", flexion_name(joint), fmt::format("{}", 12 - s / 2),
                          fmt::format("{}", 40 + 2 * s + 2 * static_cast<int>(joint))});
  }
  return log;
}

TEST(PosePdf, HasAPageForEachTwentySessionsOfAPerson) {
  const auto pages_of = [](const std::vector<StudyTable>& logs) {
    const auto pdf = pose_pdf(logs);
    EXPECT_TRUE(pdf);
    EXPECT_TRUE(pdf->starts_with("%PDF-"));
    EXPECT_NE(pdf->find("%%EOF"), pdf->npos);
    int pages = 0;
    for (std::size_t at = 0; (at = pdf->find("/Type /Page ", at)) != pdf->npos; ++at) ++pages;
    return pages;
  };
  EXPECT_EQ(pages_of({log_of_sessions(1)}), 1);
  EXPECT_EQ(pages_of({log_of_sessions(20), log_of_sessions(21)}), 3);
  auto wrong = log_of_sessions(2);
  wrong.rows[1][4] = "wide";
  EXPECT_FALSE(pose_pdf({wrong}));
}

TEST(PosePdf, ABarIsAsHighAsTheRangeOfItsJoint) {
  constexpr int kScale = 2;
  const auto page_of = [](int sessions) {
    preview::Canvas page(595 * kScale, 842 * kScale, preview::Colour::of(0xffffff), kScale);
    const auto all = pose_sessions(log_of_sessions(sessions));
    EXPECT_TRUE(all);
    draw_pose_page(page, "7", *all, 1);
    return page.picture();
  };
  const auto blue = [](const renderer::Texture& page) {
    return std::ranges::count(page.pixels(), 0xffc47312u);
  };
  // The ranges of the first six sessions grow; six bars are as wide as one.
  const auto one = blue(page_of(1)), six = blue(page_of(6));
  EXPECT_GT(one, 14 * 60);
  EXPECT_GT(six, 6 * one);
  EXPECT_LT(six, 8 * one);
  const char* folder = std::getenv("HANDCAST_PICTURES");
  EXPECT_TRUE(!folder ||
              renderer::write_png(std::string(folder) + "/pose_page.png", page_of(15).view()));
}

TEST(PosePictures, BonesAreGreenWhereTheyMatchAndRedWhereNot) {
  const auto mesh = renderer::load_hand_or_default("", renderer::Side::left);
  ASSERT_TRUE(mesh);
  PosePicture picture(*mesh, 640, 400);
  const auto poses = builtin_poses();
  const HandLayout layout(*mesh, 640, 400);
  // An open hand that should point: the index finger is right, the little finger is not.
  const auto drawn = picture.draw(&poses[2], score_of(poses[2], poses[0]));
  const auto at = [&](std::size_t finger) {
    const glm::ivec2 px(layout.tip(finger, Face::back).middle_px);
    return drawn.at(px.x, px.y);
  };
  EXPECT_GT(at(1) >> 8 & 0xff, 200u);
  EXPECT_LT(at(1) & 0xff, 100u);
  EXPECT_GT(at(4) & 0xff, 200u);
  EXPECT_LT(at(4) >> 8 & 0xff, 100u);
  const char* folder = std::getenv("HANDCAST_PICTURES");
  EXPECT_TRUE(!folder || renderer::write_png(std::string(folder) + "/pose.png", drawn));
}

}  // namespace
}  // namespace handcast::study
