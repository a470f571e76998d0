// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/figures/figures.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace handcast::supervisor {
namespace {

using nlohmann::json;

TEST(Figures, AreTheSameAfterTheWayThroughAnAnswer) {
  const auto status = json::parse(R"json({
    "rig": "desk", "uptime_s": 75.5, "keeper_died": true,
    "services": {"camera": {"state": "failed", "pid": 0, "standby": 102, "backend": "twin", "instead_of": "aravis", "uptime_s": 1.5,
                 "restarts": 12, "last_exit": "exit 111", "reason": "died", "retry_s": 2.5, "silent_ms": 7.25, "log": ["a", "b"]}},
    "rings": {"camera.frames": {"wanted_hz": 240.0, "held_hz": 239.5, "is_held_to_it": true, "is_settled": true, "count": 5000000000,
              "newest_age_ms": 1.5}},
    "light": {"projector": {"times_by": "kernel", "missed_refreshes": 7, "doubled_frames": 5}},
    "slow_frames": {"projector2": {"count": 100, "least_us": 1900.5, "preempted": 60, "interrupted": 20, "page_faults": 5, "own": 15}},
    "lost_images": {"missing": 3}, "tracker_faults": {"frozen": 2},
    "tracker_drift": {"moved": true, "places": 9, "across_mm": 5.5, "turn_deg": 0.25},
    "bridge": {"clock_error_us": 84.5, "refused": 7},
    "stage_us": {"draw": {"p50": 1500.0, "p99": 2500.0, "count": 100}}, "rungs": {"hold": 7}})json");
  EXPECT_EQ(to_json(figures_in(status)), status);
}

TEST(Figures, WhatIsNotKnownIsNull) {
  Figures figures;
  figures.services["pose"];
  figures.streams["pose.hands"];
  const auto status = to_json(figures);
  EXPECT_TRUE(status["tracker_drift"].is_null());
  for (const auto* key : {"standby", "instead_of", "last_exit", "reason", "retry_s", "silent_ms"})
    EXPECT_TRUE(status["services"]["pose"].at(key).is_null()) << key;
  EXPECT_TRUE(status["rings"]["pose.hands"].at("wanted_hz").is_null());
  EXPECT_EQ(figures_in(status).services.at("pose").last_exit, "");
}

TEST(Figures, AStatusOfNonsenseIsLeftOut) {
  for (const auto* text :
       {"[]", "7", "null", R"({"services":7,"rings":[],"light":[1]})",
        R"({"services":{"camera":7},"rings":{"camera.frames":7},"uptime_s":"x"})",
        R"({"services":{"camera":{"state":1,"pid":"x","log":[1]}},"lost_images":{"a":"?"}})"}) {
    const auto figures = figures_in(json::parse(text));
    EXPECT_EQ(figures.uptime_s, 0) << text;
    EXPECT_TRUE(figures.streams.empty() && figures.lost_images.empty()) << text;
    EXPECT_TRUE(figures.lights.empty()) << text;
    EXPECT_NE(print_status(figures), "");
  }
}

/// Found by fuzzing the exporter.
TEST(Figures, NumbersThatNoStatusHasAreLimited) {
  const auto camera =
      figures_in(
          json{{"services",
                {{"camera", {{"retry_s", 2.2e10}, {"restarts", 1e300}, {"uptime_s", -1e300}}}}}})
          .services.at("camera");
  EXPECT_EQ(camera.retry_s, 1e9);
  EXPECT_EQ(camera.restarts, 1'000'000'000);
  EXPECT_EQ(camera.uptime_s, 0);
}

}  // namespace
}  // namespace handcast::supervisor
