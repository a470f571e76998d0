// SPDX-License-Identifier: Apache-2.0
// Traces and latencies of a running rig.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "tests/supervisor/look/trace/trace_decoder.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;

class Traces : public SystemTest {
 protected:
  std::filesystem::path file_ = scratch_.path() / "rig.pftrace";

  supervisor::test::SeenTrace trace(const Arguments& more = {}) const {
    Arguments arguments{"trace", "-o", file_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = handcast(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.log;
    std::ostringstream bytes;
    bytes << std::ifstream(file_, std::ios::binary).rdbuf();
    return supervisor::test::decode_trace(bytes.str());
  }
  nlohmann::json latency() const {
    return nlohmann::json::parse(handcast({"latency", "--json"}).output, nullptr, false);
  }
};

/// The services through which the flows of a trace pass, from the exposure to the light.
std::vector<std::string> tracks_of(const std::vector<supervisor::test::SeenSlice>& way) {
  std::vector<std::string> tracks;
  for (const auto& slice : way)
    if (tracks.empty() || tracks.back() != slice.track) tracks.push_back(slice.track);
  return tracks;
}

TEST_F(Traces, ATraceFollowsAFrameFromItsExposureToTheLight) {
  const auto rig = up();
  wait_until_light();
  const auto has_a_detected_frame = [this] {
    const auto seen = trace();
    for (const auto& detect : seen.named("detect"))
      if (tracks_of(seen.along(detect.flows.empty() ? 0 : detect.flows[0])).size() == 3)
        return true;
    return false;
  };
  ASSERT_TRUE(eventually(has_a_detected_frame));

  const auto seen = trace();
  ASSERT_EQ(seen.fault, "");
  EXPECT_EQ(seen.process, "handcast twin");
  int whole = 0;
  for (const auto& detect : seen.named("detect")) {
    ASSERT_FALSE(detect.flows.empty());
    const auto way = seen.along(detect.flows[0]);
    if (tracks_of(way) != std::vector<std::string>{"camera", "landmarks", "projector"}) continue;
    ++whole;
    EXPECT_EQ(way[0].name, "capture");
    EXPECT_EQ(way[0].annotations.at("frame_id"), way[1].annotations.at("frame_id"));
    EXPECT_LT(way[0].begin_ns, way[1].begin_ns);
    EXPECT_LE(way[1].end_ns, way[2].begin_ns) << "a frame uses only earlier detections";
  }
  EXPECT_GT(whole, 0);
  for (const auto& draw : seen.named("draw"))
    EXPECT_EQ(seen.slices.at(static_cast<std::size_t>(draw.parent)).name, "frame");
}

TEST_F(Traces, LatencyTellsEveryStageAndTheWayFromExposureToLight) {
  const auto rig = up();
  wait_until_light();
  ASSERT_TRUE(eventually([this] { return latency()["end_to_end"].size() == 7; }));
  const auto figures = latency();
  std::vector<std::string> services;
  for (const auto& service : figures["services"]) services.push_back(service["service"]);
  EXPECT_THAT(services, testing::ElementsAre("camera", "pose", "landmarks", "projector"));
  EXPECT_EQ(figures["services"][0]["wanted_hz"], 60);
  EXPECT_TRUE(figures["services"][2]["wanted_hz"].is_null());
  for (const auto* rows : {"stages", "end_to_end"}) {
    for (const auto& row : figures[rows]) {
      EXPECT_GT(row["count"], 0) << row;
      EXPECT_LE(row["p50_us"], row["p99_us"]) << row;
      EXPECT_LE(row["p999_us"], row["max_us"]) << row;
    }
  }
  EXPECT_THAT(handcast({"latency", "--seconds", "2"}).output, HasSubstr("image delivered"));
}

TEST_F(Traces, WhatCannotBeAskedIsToldInASentence) {
  EXPECT_EQ(handcast({"trace"}).exit_code, 2);
  EXPECT_EQ(handcast({"trace", "-o", "x", "--seconds", "never"}).exit_code, 2);
  EXPECT_EQ(handcast({"latency", "--seconds", "-1"}).exit_code, 2);
  const auto nobody = handcast({"trace", "-o", file_.string()});
  EXPECT_EQ(nobody.exit_code, 111);
  EXPECT_THAT(nobody.log, HasSubstr("no rig is up"));
  EXPECT_FALSE(std::filesystem::exists(file_));
  const auto rig = up();
  wait_until_light();
  const auto nowhere = handcast({"trace", "-o", "/nowhere/x.pftrace"});
  EXPECT_EQ(nowhere.exit_code, 100);
  EXPECT_THAT(nowhere.log, HasSubstr("/nowhere/x.pftrace"));
}

}  // namespace
}  // namespace handcast::system_test
