#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/control_server.hpp"
#include "supervisor/event_loop.hpp"
#include "supervisor/recorder.hpp"
#include "supervisor/service.hpp"
#include "supervisor/status.hpp"

namespace handcast::supervisor {

struct RunOptions {
  std::filesystem::path rig_file;
  std::vector<std::string> settings;         ///< --set path=value, for every service
  std::filesystem::path program_folder;      ///< where the daemons are
  std::optional<double> seconds;             ///< how long; empty: until told to stop
  std::optional<std::filesystem::path> out;  ///< where live.json goes
};

/// One rig from start to stop: its rings, its services, its control socket, its recorder. One thread, one event loop.
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
  Result<void> make_rings(const config::Rig& rig);
  Result<void> open_descriptors();

  void tick();
  void replace_the_silent(std::int64_t now_ns);
  void progress(std::int64_t now_ns);
  void on_event(Service& service, Service::Event event);
  void on_ready(Service& service);
  void on_failed(Service& service);
  void begin_stop(int exit_code);
  void stop_next();
  void finish();

  void on_request(const Request& request, ControlServer::Reply reply);
  void change(const Request& request, ControlServer::Reply reply);
  Result<void> check_backend(const std::string& service, const std::string& backend) const;
  Service* find(std::string_view name) const;
  RigView view() const { return {name_, services_, recorder_, started_ns_, now_ns()}; }

  std::string name_;
  RunOptions options_;
  EventLoop loop_;
  UniqueFd signals_, timer_;
  std::vector<ipc::Segment> rings_;
  Launch launch_;
  Recorder recorder_;
  std::unique_ptr<ControlServer> control_;
  Services services_;

  Phase phase_ = Phase::starting;
  int exit_code_ = 0;
  std::int64_t started_ns_ = 0;
  std::int64_t next_progress_ns_ = 0;
  std::map<std::string, Pending> pending_;
  std::vector<ControlServer::Reply> waiting_for_stop_;
};

}  // namespace handcast::supervisor
