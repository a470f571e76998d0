// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace handcast::supervisor {

/// A service of a rig.
struct ServiceFigures {
  std::string state;             ///< one of kStateNames
  std::string backend;           ///< the one that runs
  std::string instead_of;        ///< the one that was asked for, if a fallback runs; otherwise ""
  std::string last_exit;         ///< how the last process ended; "" if none has
  std::string reason;            ///< why the service is not well; "" if it is, or nobody knows
  std::vector<std::string> log;  ///< its last lines if it is not well
  /// Pids of the service and of its standby; 0: none.
  /// @{
  pid_t pid = 0, standby_pid = 0;
  /// @}
  int restarts = 0;                 ///< number of restarts
  double uptime_s = 0;              ///< time since its process was started
  std::optional<double> retry_s;    ///< time until it is started again
  std::optional<double> silent_ms;  ///< time since its last heartbeat

  /// True if the service runs, or was stopped on request.
  bool well() const { return state == "ready" || state == "stopped"; }
};

/// The stream of a service, as its stage marks tell it.
struct StreamFigures {
  std::optional<double> wanted_hz;      ///< the configured rate; empty if there is none
  double held_hz = 0;                   ///< mean over the last seconds
  bool is_held_to_it = false;           ///< less than the wanted rate is a fault
  bool is_settled = false;              ///< the service runs long enough to be judged
  std::uint64_t count = 0;              ///< messages
  std::optional<double> newest_age_ms;  ///< empty: there was no message

  /// True if the stream holds less than 90 % of a rate that it is held to.
  bool slow() const;
};

/// The light of a projector.
struct LightFigures {
  std::string times_by;                ///< what says when light comes, one of kLightSourceNames
  std::uint64_t missed_refreshes = 0;  ///< refreshes without a new frame
  std::uint64_t doubled_frames = 0;    ///< frames shown for several refreshes
};

/// The slowest frames of a projector, by what made them slow (SlowFrames::Causes).
struct SlowFrameFigures {
  std::uint64_t count = 0;  ///< at most 100
  double least_us = 0;      ///< the time of the fastest of them
  /// @{
  std::uint64_t preempted = 0, interrupted = 0, page_faults = 0, own = 0;
  /// @}
};

/// Where the tracker seems to be, relative to its calibration.
struct DriftFigures {
  bool moved = false;    ///< it is not where the calibration says
  int places = 0;        ///< places of still hands that tell this
  double across_mm = 0;  ///< across the camera's axis
  double turn_deg = 0;
};

/// What comes from another computer.
struct BridgeFigures {
  double clock_error_us = 0;  ///< that computer's clock is known to so much
  std::uint64_t refused = 0;  ///< messages that were not used; 65535: or more
};

/// The time of a stage in the last ten seconds.
struct StageFigures {
  double p50_us = 0, p99_us = 0;
  std::uint64_t count = 0;
};

/// The figures of a rig at one moment, as its supervisor knows them. All printers start from them:
/// `handcast status`, `top`, `latency` and the exporter.
struct Figures {
  std::string rig;
  double uptime_s = 0;       ///< time since the rig's start, also under earlier supervisors
  bool keeper_died = false;  ///< a dead supervisor would not be replaced
  std::map<std::string, ServiceFigures> services;
  std::map<std::string, StreamFigures> streams;
  std::map<std::string, LightFigures> lights;           ///< by projector; none of one without light
  std::map<std::string, SlowFrameFigures> slow_frames;  ///< by projector
  std::map<std::string, std::uint64_t> lost_images;     ///< of the camera, by reason
  std::map<std::string, std::uint64_t> tracker_faults;  ///< how often each began, by kind
  std::optional<DriftFigures> tracker_drift;            ///< empty: nothing is known
  std::optional<BridgeFigures> bridge;                  ///< empty: nothing has come
  std::map<std::string, StageFigures> stages;
  std::map<std::string, std::uint64_t> rungs;  ///< hands in drawn frames, by rung of the ladder
};

/// The status of a rig in the answers of its supervisor, as `handcast status --json` prints it.
/// @{
nlohmann::json to_json(Figures figures);
/// What has another type is left out, and numbers are limited to 0 to 1e9, counts to 64 bits: they
/// may be of a supervisor of another version.
Figures figures_in(const nlohmann::json& status);
/// @}

/// The output of `handcast status`.
std::string print_status(const Figures& figures);

}  // namespace handcast::supervisor
