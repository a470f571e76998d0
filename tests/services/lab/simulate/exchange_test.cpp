// SPDX-License-Identifier: Apache-2.0
// Results of other methods are scored as the twin's own sensors are.
#include "services/lab/simulate/exchange.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "services/lab/simulate/score.hpp"
#include "tests/services/lab/simulate/run_rig.hpp"

namespace handcast::simulate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kNames = "origin_ns,arrival_ns,side\n";

class ExchangeTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
  }
  /// A row of `columns`: the head, then `value` in each.
  static std::string row(const std::string& head, std::size_t columns, const char* value) {
    std::string line = head;
    for (std::size_t i = 4; i < columns; ++i) line += std::string(",") + value;
    return line + '\n';
  }

  /// The metrics of a short run; `change` sets further options.
  template <class Change>
  nlohmann::json metrics(const Change& change) const {
    Options options = options_of("twin", 0.4);
    add_settings(options, {"twin.motion=builtin:two_hands", "twin.tracker.dropout=0.1"});
    options.warm_up_s = kWarmUp_s;
    options.draw_every = 48;
    options.json_file = file("metrics.json");
    change(options);
    const auto done = run(options);
    EXPECT_TRUE(done) << done.error().what;
    auto json = nlohmann::json::parse(std::ifstream(options.json_file));
    for (const auto* of_machine : {"frame_us", "stage_us"}) json.erase(of_machine);
    return json;
  }

  const test::Scratch folder_;
};

TEST_F(ExchangeTest, WhatTheTwinsSensorsDeliveredScoresTheSameWhenItIsGivenBack) {
  auto own = metrics([&](Options& options) { options.record_directory = file("twin"); });
  auto back = metrics([&](Options& options) {
    options.poses_file = file("twin/poses.csv");
    options.landmarks_file = file("twin/landmarks.csv");
    add_settings(options, {"pose.backend=external", "landmarks.backend=external"});
  });
  EXPECT_EQ(back["poses"], file("twin/poses.csv").string());
  EXPECT_NEAR(figure(back, "/detector/error_px/mean"), figure(own, "/detector/error_px/mean"), 0.01)
      << "but for the runs that were not done at the end";
  for (auto* json : {&own, &back})
    for (const auto* said : {"poses", "detector"}) json->erase(said);
  EXPECT_EQ(own, back);
}

TEST_F(ExchangeTest, PosesThatAreWrongScoreWorse) {
  const auto by_tracker_alone = [&](Options& options) {
    add_settings(options, {"cascade.filter.method=none", "cascade.register.method=none"});
  };
  const auto own = metrics([&](Options& options) {
    by_tracker_alone(options);
    options.record_directory = file("twin");
  });
  auto poses = read_poses(file("twin/poses.csv"));
  ASSERT_TRUE(poses) << poses.error().what;
  for (auto& event : *poses)
    for (auto& hand : std::get<msg::HandPoses>(event.message).hands)
      for (auto& joint : hand.joints) joint.position_m[0] += 0.02f;
  const auto twin = twin_of(rig_with({}));
  ASSERT_TRUE(write_exchange(file("twin"), *poses, {}, *twin, {}));
  const auto wrong = metrics([&](Options& options) {
    by_tracker_alone(options);
    options.poses_file = file("twin/poses.csv");
  });
  EXPECT_GT(figure(wrong, "/interior_mm/mean"), figure(own, "/interior_mm/mean") + 5);
}

TEST_F(ExchangeTest, LandmarksThatAreWrongScoreWorse) {
  const auto own = metrics([&](Options& options) { options.record_directory = file("twin"); });
  auto landmarks = read_landmarks(file("twin/landmarks.csv"), calib::CameraModel());
  ASSERT_TRUE(landmarks) << landmarks.error().what;
  for (auto& event : *landmarks)
    for (auto& hand : std::get<msg::Landmarks>(event.message).hands)
      for (auto& point : hand.points) point.x_px += 20;
  const auto twin = twin_of(rig_with({}));
  ASSERT_TRUE(write_exchange(file("twin"), *landmarks, {}, *twin, calib::CameraModel()));
  const auto wrong =
      metrics([&](Options& options) { options.landmarks_file = file("twin/landmarks.csv"); });
  EXPECT_GT(figure(wrong, "/landmark_px/mean"), figure(own, "/landmark_px/mean") + 5);
  EXPECT_GT(figure(wrong, "/detector/error_px/mean"), 15);
}

TEST_F(ExchangeTest, LandmarksOfTheImagesOfAnotherRunAreRefused) {
  metrics([&](Options& options) { options.record_directory = file("twin"); });
  Options options = options_of("twin", 0.4);
  options.warm_up_s = kWarmUp_s;
  options.landmarks_file = file("twin/landmarks.csv");
  add_settings(options, {"twin.motion=builtin:two_hands", "camera.rate_hz=60"});
  const auto done = run(options);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, Errc::bad_config);
  EXPECT_THAT(done.error().what, HasSubstr("are of no image of this run"));
}

TEST_F(ExchangeTest, TheTruthIsThatOfTheImages) {
  metrics([&](Options& options) { options.record_directory = file("twin"); });
  const auto poses = read_poses(file("twin/true_poses.csv"));
  const auto landmarks = read_landmarks(file("twin/true_landmarks.csv"), calib::CameraModel());
  ASSERT_TRUE(poses && landmarks);
  ASSERT_EQ(poses->size(), landmarks->size());
  const auto images = static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(file("twin/camera")), {}));
  EXPECT_EQ(poses->size(), images);
  const auto& hands = std::get<msg::HandPoses>(poses->back().message);
  const auto twin =
      twin_of(rig_with({"twin.motion=builtin:two_hands", "twin.tracker.dropout=0.1"}));
  const auto joints = twin->joints(msg::Side::right, hands.header.origin_ns);
  ASSERT_TRUE(joints);
  EXPECT_NEAR(hands.find(msg::Side::right)->joints[10].position_m[1], (*joints)[10][3].y, 1e-4);
}

TEST_F(ExchangeTest, RowsWithTheSameTimesAreOneMessageAndThoseWithoutAHandAreEmpty) {
  write("points.csv",
        kNames + row("5,9,0,1", 88, "1") + row("5,9,1,0.5", 88, "1") + row("7,8,-1,0", 88, "0"));
  const auto events = read_landmarks(file("points.csv"), calib::CameraModel());
  ASSERT_TRUE(events) << events.error().what;
  ASSERT_EQ(events->size(), 2u);
  ASSERT_EQ(events->front().arrival_ns, 8) << "in the order of arrival";
  EXPECT_EQ(std::get<msg::Landmarks>(events->front().message).count, 0u);
  EXPECT_EQ(std::get<msg::Landmarks>(events->back().message).count, 2u);
  EXPECT_EQ(std::get<msg::Landmarks>(events->back().message).find(msg::Side::right)->presence,
            0.5f);
}

TEST_F(ExchangeTest, AnArrayOfNumPyIsReadAsATable) {
  std::string head = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 88), }";
  head.append(117 - head.size(), ' ');
  std::vector<double> values(88, 0.25);
  values[0] = 1e9 + 1;
  values[1] = 2e9;
  values[2] = 1;
  std::ofstream out(file("points.npy"), std::ios::binary);
  out << "\x93NUMPY" << '\x01' << '\0' << '\x76' << '\0' << head << '\n';
  out.write(reinterpret_cast<const char*>(values.data()), 88 * sizeof(double));
  out.close();
  const auto events = read_landmarks(file("points.npy"), calib::CameraModel());
  ASSERT_TRUE(events) << events.error().what;
  const auto& landmarks = std::get<msg::Landmarks>(events->at(0).message);
  EXPECT_EQ(landmarks.header.origin_ns, 1'000'000'001);
  EXPECT_EQ(landmarks.hands[0].side, msg::Side::right);
}

TEST_F(ExchangeTest, ATableWithoutHeadingOrRowsIsNotAMethodThatFindsNothing) {
  for (const auto& [text, why] :
       {std::pair{std::string(), "first line"}, std::pair{row("5,9,0,1", 88, "1"), "first line"},
        std::pair{kNames, "no rows"}}) {
    write("points.csv", text);
    const auto events = read_landmarks(file("points.csv"), calib::CameraModel());
    ASSERT_FALSE(events) << why;
    EXPECT_THAT(events.error().what, AllOf(HasSubstr("points.csv"), HasSubstr(why)));
  }
}

TEST_F(ExchangeTest, WhatNoSensorDeliversIsRefusedWithItsRow) {
  for (const auto& [text, why] :
       {std::pair{row("0,1,0,1", 87, "1"), "columns"}, std::pair{row("0,1,2,1", 88, "1"), "side"},
        std::pair{row("0,1,0,1", 88, "nan"), "row 1"}, std::pair{row("0,nan,0,1", 88, "1"), "time"},
        std::pair{row("99000000,1,0,1", 88, "1"), "before it was seen"},
        std::pair{row("0,1,0,1", 88, "x"), "line 2"},
        std::pair{row("0,1,0,1", 88, "1") + row("0,1,0,1", 88, "1"), "same side"}}) {
    write("points.csv", kNames + text);
    const auto events = read_landmarks(file("points.csv"), calib::CameraModel());
    ASSERT_FALSE(events) << why;
    EXPECT_THAT(events.error().what, HasSubstr(why));
    EXPECT_THAT(events.error().what, HasSubstr("points.csv"));
  }
  EXPECT_FALSE(read_poses(file("nowhere.csv")));
}

}  // namespace
}  // namespace handcast::simulate
