// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// The contract between the supervisor and the daemons that it starts. It is also the way to run a
/// daemon by hand in a test.
///
///   argv   [--as NAME] --config FILE [--set path=value]... [--of-rig MARK]
///              NAME: the service that it is, of a program that can be several.
///              MARK: says the same as HANDCAST_RIG to those from whom the kernel hides the
///              environment of a daemon that has capabilities. A daemon does not use it.
///
///   env    HANDCAST_RINGS=camera.frames=5,pose.hands=6
///              The descriptors of the rings' segments, by stream.
///          HANDCAST_READY_FD=7
///              The daemon writes '\n' here when it is ready. A standby writes 's' when it is
///              prepared and again every half second until it gets its turn.
///          HANDCAST_EPOCH_NS=123456789
///              The time of the rig's start (CLOCK_MONOTONIC, ns), the same for every daemon of the
///              rig: time zero of the twin and of recordings.
///          HANDCAST_STANDBY_FD=8
///              Set for a standby. It prepares everything that a second process may have, then
///              waits here for the byte '1', its turn. If the other end is closed, it ends with
///              exit 0. In its turn, the process that it replaces may be alive and still stopping:
///              it waits for what that one holds, e.g. the writer lock of a ring.
///          HANDCAST_RIG=handcast-1000//twin
///              The address of its rig (ipc/control/rig_address.hpp). A daemon does not use it: by
///              it the daemons of a rig are found among all processes.
///          HANDCAST_STATE_FD=9
///              The memory with the saved state of the supervisor. A daemon only holds it open, for
///              a successor of the supervisor.
///          HANDCAST_OUT=DIR
///              Where files to be kept are written (scores, pictures). Unset: nowhere.
///
///   life   A daemon publishes a message in the ring marks.NAME at least every kBeatEvery_ns: stage
///          marks, or an empty one. The supervisor replaces a daemon that has been silent for
///          supervisor.silent_s; earlier if all its threads are stopped or asleep meanwhile
///          (supervisor/life/next.hpp).
///
///   exit   See ipc/base/exit_code.hpp. 0 (stopped on request, or its work is done) and 100 (a
///          person must change something) are final. After all other codes, and after a signal, the
///          daemon is restarted.
///
///   SIGTERM   Stop at once: first leave the rings that it writes, because another process may be
///             waiting for them, then end.
///   SIGINT    Stop for good, because the rig stops: no other process takes over. A daemon may end
///             its work before, e.g. let its light fade, in less than supervisor.stop_s. A second
///             signal of either kind means: at once.
namespace handcast::daemon {

inline constexpr const char* kRigOption = "--of-rig";  ///< see argv

/// The names of the environment variables.
/// @{
inline constexpr const char* kRingsVariable = "HANDCAST_RINGS";
inline constexpr const char* kReadyVariable = "HANDCAST_READY_FD";
inline constexpr const char* kEpochVariable = "HANDCAST_EPOCH_NS";
inline constexpr const char* kStandbyVariable = "HANDCAST_STANDBY_FD";
inline constexpr const char* kRigVariable = "HANDCAST_RIG";
inline constexpr const char* kStateVariable = "HANDCAST_STATE_FD";
inline constexpr const char* kOutVariable = "HANDCAST_OUT";
/// @}

/// The variables that differ from daemon to daemon: none is inherited from the supervisor's own
/// environment.
inline constexpr std::array kHandoverVariables{kRingsVariable,   kReadyVariable, kEpochVariable,
                                               kStandbyVariable, kRigVariable,   kStateVariable};

inline constexpr char kReadyWord = '\n';    ///< on the ready descriptor
inline constexpr char kPreparedWord = 's';  ///< on the ready descriptor, from a standby
inline constexpr char kTurnWord = '1';      ///< on the standby descriptor

/// The longest time between two messages of a daemon's stage marks.
inline constexpr std::int64_t kBeatEvery_ns = 100'000'000;
/// The period in which a prepared standby repeats kPreparedWord.
inline constexpr std::int64_t kPreparedEvery_ns = 500'000'000;

/// The stream of a daemon's stage marks, which are also its heart-beat.
inline std::string marks_stream_of(std::string_view daemon) {
  return "marks." + std::string(daemon);
}

/// The folder for files to be kept; empty if nothing is to be kept.
inline std::optional<std::filesystem::path> out_folder() {
  const char* folder = std::getenv(kOutVariable);
  return folder ? std::optional<std::filesystem::path>(folder) : std::nullopt;
}

}  // namespace handcast::daemon
