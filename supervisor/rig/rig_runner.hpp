// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/control/control_server.hpp"
#include "supervisor/life/service.hpp"
#include "supervisor/record/recorder.hpp"
#include "supervisor/rig/status.hpp"
#include "supervisor/succession/adoption.hpp"
#include "supervisor/succession/systemd.hpp"

namespace handcast::supervisor {

struct RunOptions {
  std::filesystem::path rig_file;
  std::vector<std::string> settings;         ///< --set path=value, for every service
  std::filesystem::path program_folder;      ///< where the daemons are
  std::optional<double> seconds;             ///< how long; empty: until told to stop
  std::optional<std::filesystem::path> out;  ///< where live.json goes
  bool is_successor =
      false;  ///< of a supervisor that died under the same keeper: --seconds goes on
};

/// A reload that is answered when everything it touched has settled (rig_reload.cpp).
struct Reload {
  ControlServer::Reply reply;
  bool revives = true;   ///< those that have given up are tried again
  bool changed = false;  ///< the file says something else than before
  std::vector<std::string> restarted, started, stopped;  ///< services, as the person is told
  std::vector<std::string>
      waiting;  ///< of these: not begun, because what they need has not settled
  std::map<std::string, std::int64_t, std::less<>>
      begun;                          ///< of these: until when they must have settled
  std::vector<std::string> failures;  ///< a sentence each
};

/// One rig from start to stop: its rings, its services, its control socket, its recorder. One
/// thread, one event loop.
class RigRunner {
 public:
  /// Makes everything that can fail before the first service starts.
  static Result<std::unique_ptr<RigRunner>> open(const config::Rig& rig, RunOptions options);
  /// Runs until it is told to stop. The exit code of `handcast up`.
  int run();

 private:
  enum class Phase { starting, up, stopping, done };

  /// A request that is answered when a service is ready again.
  struct Pending {
    ControlServer::Reply reply;
    std::string wanted, before;  ///< back ends; empty for a plain restart
    std::string reason;          ///< why `wanted` did not start; empty while it is tried
  };

  RigRunner(const config::Rig& rig, RunOptions options, EventLoop loop);
  /// Goes on with what a supervisor that died has left, or makes everything anew
  /// (rig_adoption.cpp).
  Result<void> inherit_or_make(const config::Rig& rig);
  Result<void> take_over(AdoptedRig adopted, const config::Rig& rig);
  void continue_run(const SavedRig& saved);
  void report_deaths(const AdoptedRig& adopted);
  Result<void> make_rings(const config::Rig& rig);
  Result<void> open_descriptors();

  void tick();
  void follow_up();
  bool needs_are_ready(const Service& service) const;
  bool may_begin(const Service& service, std::int64_t now_ns) const;
  bool need_not_be_waited_for(const Service& service, std::int64_t now_ns) const;
  void start_those_held();
  void come_up();
  void forgive_a_standstill(std::int64_t now_ns);
  Service::Look look_at(const Service& service, std::int64_t now_ns) const;
  void progress(std::int64_t now_ns);
  void on_notice(Service& service, Notice notice);
  void on_ready(Service& service);
  void on_failed(Service& service);
  void begin_stop(int exit_code);
  void stop_next();
  void finish();

  void on_request(const Request& request, ControlServer::Reply reply);
  void change(const Request& request, ControlServer::Reply reply);
  /// Makes this rig the one that is applied: restarts the services whose fingerprints changed, and
  /// where it `revives` those that have given up (rig_reload.cpp).
  void reload(Result<config::Rig> rig, bool revives, ControlServer::Reply reply);
  std::string why_not_reload() const;
  Result<void> check_change(const config::Rig& rig, const std::vector<ServiceSpec>& specs) const;
  Result<void> add_rings(const std::vector<ServiceSpec>& specs);
  void apply(const std::vector<ServiceSpec>& specs);
  void add_service(const ServiceSpec& spec, std::size_t place);
  /// The file's rig with the back ends that `handcast swap` put in their place.
  config::Rig with_swaps(config::Rig rig) const;
  /// On every tick: begins what may begin, answers when all has settled.
  void continue_reload(std::int64_t now_ns);
  void begin_what_may(std::int64_t now_ns);
  void settle(std::int64_t now_ns);
  void answer_reload();
  /// Restarts a service with another back end, and remembers with which settings that is.
  void give_backend(Service& service, const std::string& backend, bool on_trial);
  void give_rings(const ControlServer::Reply& reply) const;
  void give_history(const Request& request, const ControlServer::Reply& reply) const;
  /// Leaves word for a successor (saved_rig.hpp); call it whenever a service was started, got
  /// ready, ended or was changed.
  void save() const;
  Result<void> check_backend(const std::string& service, const std::string& backend) const;
  Service* find(std::string_view name) const;
  RigView view() const { return {name_, services_, recorder_, started_ns_, now_ns()}; }

  std::string name_;
  config::Rig rig_;  ///< as the file was when it was last applied
  RunOptions options_;
  EventLoop loop_;
  UniqueFd signals_, timer_;
  ExitReports reports_ = ExitReports::from_environment();
  std::vector<ipc::Segment> rings_;
  Launch launch_;
  Recorder recorder_;
  std::unique_ptr<ControlServer> control_;
  Services services_;

  Watchdog watchdog_;
  Phase phase_ = Phase::starting;
  bool inherited_ = false;  ///< from a supervisor that died
  int exit_code_ = 0;
  std::int64_t started_ns_ = 0;
  std::int64_t next_progress_ns_ = 0;
  std::int64_t last_tick_ns_ = 0;
  std::uint64_t revision_ = 0;  ///< of all services, as last saved
  mutable bool save_failed_ = false;
  std::map<std::string, Pending> pending_;
  std::optional<Reload> reload_;
  std::vector<ControlServer::Reply> waiting_for_stop_;
};

}  // namespace handcast::supervisor
