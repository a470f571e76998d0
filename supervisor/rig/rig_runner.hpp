// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/rig/diary.hpp"
#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/requests.hpp"
#include "supervisor/succession/adoption.hpp"
#include "supervisor/succession/descriptor_store.hpp"
#include "supervisor/succession/systemd.hpp"

namespace handcast::supervisor {

/// The options of `handcast up`.
struct RunOptions {
  std::filesystem::path rig_file;            ///< the user's rig file
  std::vector<std::string> settings;         ///< --set path=value
  std::filesystem::path program_folder;      ///< folder of the daemons
  std::optional<double> seconds;             ///< --seconds; empty: until a request or a signal
  std::optional<std::filesystem::path> out;  ///< --out: folder of live.json
  /// It follows a supervisor that died under the same keeper: `seconds` counts from that one's
  /// start.
  bool is_successor = false;
};

/// Runs one rig from start to stop. One thread, one event loop.
class RigRunner {
 public:
  /// Claims the rig's name and creates its rings, or takes over a rig whose
  /// supervisor died. Does not start services. Errors: bad_config,
  /// unavailable; living services of the rig are left as they are then.
  static Result<std::unique_ptr<RigRunner>> open(const config::Rig& rig, RunOptions options);
  /// Runs until a request, a signal or the end of `seconds` stops the rig. Returns the exit code of
  /// `handcast up`.
  int run();

 private:
  RigRunner(const config::Rig& rig, RunOptions options, EventLoop loop);
  int supervise();

  Result<void> claim_name();
  Result<void> watch_signals_and_time();
  Result<void> make_parts();
  Result<void> make_rings_and_files(std::optional<AdoptedRig>& adopted,
                                    const std::vector<ServiceSpec>& specs);
  void continue_run(const SavedRig& saved);

  void tick();
  void beat(std::int64_t now_ns);
  void follow_up();
  void keep_descriptors();
  void forgive_a_standstill(std::int64_t now_ns);
  void show_progress_now_and_then(std::int64_t now_ns);
  void show_progress(std::int64_t now_ns);
  void on_notice(Service& service, Notice notice);
  void on_failed(Service& service);
  void come_up();
  void begin_what_may();
  void save();

  void begin_stop(int exit_code);
  void stop_next();
  void hurry_when_late(std::int64_t now_ns);
  void hurry();
  void finish();

  RunOptions options_;
  EventLoop loop_;
  UniqueFd signals_, timer_;
  KeeperLink keeper_ = KeeperLink::from_environment();
  LiveRig rig_;
  std::unique_ptr<ControlServer> control_;
  Requests requests_;
  Watchdog watchdog_;
  std::optional<StateMemory> state_;  ///< set by open()
  DescriptorStore store_;

  bool inherited_ = false;  ///< the rig was taken over from a supervisor that died
  int exit_code_ = kExitDone;
  std::int64_t stop_by_ns_ = 0;  ///< when the services of a rig that stops are killed
  std::int64_t next_beat_ns_ = 0;
  std::int64_t next_progress_ns_ = 0;
  Diary diary_;  ///< what is logged without a terminal
  std::int64_t last_tick_ns_ = 0;
  std::uint64_t revision_ = 0;  ///< revision of the services that was saved last
  bool save_failed_ = false;
};

}  // namespace handcast::supervisor
