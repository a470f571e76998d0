// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"
#include "supervisor/look/top/top_look.hpp"

namespace handcast::supervisor::test {

inline constexpr pid_t kCameraPid = 100, kProjectorPid = 101, kStandbyPid = 102, kToolPid = 900,
                       kDeadPid = 901;

inline ProcessUsage process(std::string program, double cpu_s, std::int64_t taken_ns) {
  return {.program = std::move(program),
          .taken_ns = taken_ns,
          .cpu_ns = seconds_to_ns(cpu_s),
          .started_ticks = 5,
          .resident_bytes = 48 << 20,
          .shared_bytes = 10 << 20,
          .threads = 3,
          .descriptors = 17,
          .last_core = 1};
}

inline ipc::ReaderView reader(int row, pid_t pid, std::uint64_t received) {
  return {.row = row,
          .pid = pid,
          .received = received,
          .lag = 1,
          .age_ns = 4'200'000,
          .lease_ages_ns = {-1, -1}};
}

/// A rig made up by hand, `second` seconds into its life: a camera at 240 Hz that the projector
/// reads, a sick projector.
inline RigLook look_at(double second) {
  RigLook look{.rig = "paper", .taken_ns = seconds_to_ns(1000 + second)};
  look.figures = figures_in(nlohmann::json::parse(R"json({
    "rig": "paper", "uptime_s": 75.5,
    "services": {
      "camera": {"state": "ready", "pid": 100, "standby": 102, "backend": "twin", "uptime_s": 75, "restarts": 0, "last_exit": null},
      "projector": {"state": "degraded", "pid": 101, "backend": "file", "uptime_s": 0.5, "restarts": 12,
                    "last_exit": "signal 11 (Segmentation fault)", "reason": "died 10 times", "retry_s": 2.5,
                    "log": ["older", "projector: no \u001b[31mlamp"]}},
    "rings": {"camera.frames": {"wanted_hz": 240}},
    "stage_us": {"draw": {"p50": 1500, "p99": 2500, "count": 100}}})json"));

  const auto counted = [&](int hz) { return static_cast<std::uint64_t>(hz * second); };
  look.figures->rungs = {{"hold", 7}, {"landmarks", counted(90)}, {"register", counted(30)}};
  look.figures->lost_images = {{"missing", 0}, {"incomplete", 4}, {"skipped", counted(3)}};

  const auto count = counted(240);
  ipc::RingSnapshot frames{.stream = "camera.frames",
                           .slots = 4,
                           .epoch = 3,
                           .sequence = count + 1,
                           .published = count,
                           .dropped = 0,
                           .newest_origin_ns = look.taken_ns - 5'000'000,
                           .newest_published_ns = look.taken_ns - 2'000'000};
  frames.readers = {reader(0, kProjectorPid, count / 2), reader(1, kToolPid, count),
                    reader(4, kDeadPid, 7)};
  frames.readers[0].skipped = count / 2;
  frames.readers[1].waiting = true;
  look.rings = {
      frames,
      {.stream = "marks.camera", .slots = 254, .epoch = 1, .sequence = 9, .published = count}};
  look.processes = {{kCameraPid, process("handcast-camera", 0.25 * second, look.taken_ns)},
                    {kProjectorPid, process("handcast-projec", 3, look.taken_ns)},
                    {kToolPid, process("recorder\x1b", 0, look.taken_ns)}};
  return look;
}

}  // namespace handcast::supervisor::test
