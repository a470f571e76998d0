// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "services/tools/preview/status_gauges.hpp"
#include "tests/milliseconds.hpp"

namespace handcast::preview {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Series, KeepsTheNewestValues) {
  Series series(3);
  for (const float value : {1, 2, 3, 4}) series.add(value);
  EXPECT_THAT(series.values(), ElementsAre(2, 3, 4));
}

TEST(RateMeter, CountsMessagesThatWereNotRead) {
  RateMeter meter;
  meter.saw(1, 0);
  meter.saw(26, 50 * kMs);
  EXPECT_DOUBLE_EQ(meter.take_hz(), 500);
  meter.saw(51, 150 * kMs);
  EXPECT_DOUBLE_EQ(meter.take_hz(), 250) << "since the last call";
  EXPECT_EQ(meter.take_hz(), 0) << "nothing new";
}

TEST(RateMeter, NumbersAndTimesThatGoBackBeginAnew) {
  RateMeter meter;
  meter.saw(1000, 50 * kMs);
  meter.saw(3, 60 * kMs);
  EXPECT_EQ(meter.take_hz(), 0);
  meter.saw(4, 10 * kMs);
  EXPECT_EQ(meter.take_hz(), 0) << "a time before the last one";
}

TEST(RateMeter, TimesAtTheEndOfTheWorldAreARateLikeAnyOther) {
  RateMeter meter;
  meter.saw(1, std::numeric_limits<std::int64_t>::min());
  meter.saw(2, std::numeric_limits<std::int64_t>::max());
  EXPECT_GT(meter.take_hz(), 0);
}

TEST(Status, StagesAreInTheOrderOfAFrame) {
  const json status{
      {"uptime_s", 12.5},
      {"services", {{"camera", {{"state", "ready"}}}}},
      {"stage_us",
       {{"fill", {{"p50", 180}, {"p99", 900}}}, {"capture", {{"p50", 1300}, {"p99", 5000}}}}}};
  Gauges gauges;
  read_status(status, config::Viewpoint::first, gauges);
  EXPECT_EQ(gauges.uptime_s, 12.5);
  EXPECT_THAT(gauges.ill, IsEmpty());
  ASSERT_EQ(gauges.stages.size(), 2u);
  EXPECT_EQ(gauges.stages[0].stage, "capture");
  EXPECT_EQ(gauges.stages[1].p99_us, 900);
}

TEST(Status, TheStagesOfAFrameAreThoseOfTheProjectorThatIsShown) {
  const auto us = [](int p50) { return json{{"p50", p50}, {"p99", 9}}; };
  const json status{
      {"stage_us", {{"capture", us(1)}, {"capture2", us(2)}, {"draw", us(3)}, {"draw2", us(4)}}}};
  Gauges gauges;
  read_status(status, config::Viewpoint::second, gauges);
  ASSERT_EQ(gauges.stages.size(), 2u);
  EXPECT_EQ(gauges.stages[0].p50_us, 1) << "there is one camera for both";
  EXPECT_EQ(gauges.stages[1].stage, "draw");
  EXPECT_EQ(gauges.stages[1].p50_us, 4);
}

TEST(Status, AServiceThatIsNotWellIsNamedWithItsReason) {
  Gauges gauges;
  read_status({{"services",
                {{"camera", {{"state", "degraded"}, {"reason", "died 10 times"}}},
                 {"pose", {{"state", "starting"}, {"reason", nullptr}}},
                 {"landmarks", {{"state", "stopped"}}}}}},
              config::Viewpoint::first, gauges);
  EXPECT_THAT(gauges.ill, ElementsAre("camera is degraded: died 10 times", "pose is starting"));
}

TEST(Status, AnswersOfAnotherFormAreLeftOut) {
  for (const auto& status :
       {json(), json(3), json::array({1}), json{{"services", 3}, {"stage_us", "x"}},
        json{{"uptime_s", "long"}, {"stage_us", {{"fill", 3}, {"draw", {{"p50", "x"}}}}}},
        json{{"services", {{"camera", nullptr}}}}}) {
    Gauges gauges;
    read_status(status, config::Viewpoint::first, gauges);
    EXPECT_EQ(gauges.uptime_s, 0);
    EXPECT_THAT(gauges.stages, IsEmpty());
    EXPECT_EQ(wanted_hz(status, "camera.frames"), std::nullopt);
  }
}

TEST(Status, AStreamWithoutAFixedRateWantsNone) {
  const json status{
      {"rings",
       {{"camera.frames", {{"wanted_hz", 525}}}, {"landmarks.hands", {{"wanted_hz", nullptr}}}}}};
  EXPECT_EQ(wanted_hz(status, "camera.frames"), 525);
  EXPECT_EQ(wanted_hz(status, "landmarks.hands"), std::nullopt);
}

}  // namespace
}  // namespace handcast::preview
