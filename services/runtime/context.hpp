// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"

/// What a daemon stands on: its configuration, its rings, its readiness, its heart-beat, its stage
/// marks.
///
/// The contract with the supervisor (also the way to run a daemon by hand in a test):
///   argv   --config FILE [--set path=value]...
///   env    HANDCAST_RINGS="camera.frames=5,pose.hands=6"  descriptors of the rings' segments
///          HANDCAST_READY_FD=7       gets one newline when the daemon is ready
///          HANDCAST_EPOCH_NS=...     monotonic time of the rig's start: the twin's time zero, the
///          same for every daemon HANDCAST_OUT=DIR          where to leave what is to be kept
///          (scores, pictures); absent: nowhere HANDCAST_STANDBY_FD=8     this is a spare: it
///          prepares everything, then waits until a byte comes here (its turn) or the other
///                                    end closes (then it ends, exit 0). While it waits it writes
///                                    an 's' to the ready descriptor every half second, the first
///                                    one at once
///   exit   0 stopped as asked, 100 a person must change something (do not restart), 111 restart
///   may help SIGTERM, SIGINT: stop
namespace handcast::service {

inline constexpr int kExitConfig = 100;
inline constexpr int kExitRestart = 111;

/// Ends a daemon's start-up with the error's sentence in the log and exit 100 (bad_config,
/// bad_data: restarting will not help) or 111.
[[noreturn]] void give_up(const Error& error);

template <class T>
T must(Result<T> result) {
  if (!result) give_up(result.error());
  return std::move(*result);
}

class Context {
 public:
  const config::Rig& rig() const { return rig_; }
  const calib::Calibration& calibration() const { return calibration_; }
  std::int64_t epoch_ns() const { return epoch_ns_; }

  /// A spare gets it in its turn: see stand_by().
  template <class T>
  Result<ipc::Writer<T>> writer(std::string_view stream) {
    stand_by();
    auto segment = take_segment(stream);
    if (!segment) return tl::make_unexpected(segment.error());
    return ipc::Writer<T>::attach(std::move(*segment));
  }
  /// Without a `wait`: as the service's [NAME.process] says.
  template <class T>
  Result<ipc::Reader<T>> reader(std::string_view stream,
                                std::optional<ipc::Wait> wait = std::nullopt) {
    auto segment = take_segment(stream);
    if (!segment) return tl::make_unexpected(segment.error());
    return ipc::Reader<T>::attach(std::move(*segment), wait.value_or(wait_));
  }

  /// A spare waits here for its turn, everybody else passes. Call it after all preparation that a
  /// second process may do at the same time (models, pictures, memory), before what only one may
  /// have: writers, devices. The memory of `streams`, which it will need, is made ready before the
  /// wait. A daemon that never calls it waits at its first writer, or in ready().
  void stand_by(std::initializer_list<std::string_view> streams = {});
  /// Tells the supervisor that the daemon works: call it once, after everything that can fail at
  /// start-up.
  void ready();
  /// False after SIGTERM or SIGINT. Beats the heart: call it at least every 100 ms.
  bool running();
  /// An error of one turn of the loop: timeouts and bad items are counted (and logged, at most once
  /// a second); a lost device or a bad configuration ends the process for the supervisor to act on.
  void tolerate(const Error& error);
  /// Publishes what one frame's stages took, for traces, the report and `handcast status`.
  /// `made_from`: of a projector frame.
  void mark(const msg::Header& frame, std::span<const msg::StageMark> stages,
            const msg::MadeFrom& made_from = {});

  Context(std::string name, config::Rig rig, calib::Calibration calibration);

 private:
  Result<ipc::Segment> take_segment(std::string_view stream);
  Result<ipc::Segment> open_segment(std::string_view stream) const;
  void wait_for_turn() const;
  void open_marks();

  std::string name_;
  config::Rig rig_;
  calib::Calibration calibration_;
  std::int64_t epoch_ns_ = 0;
  ipc::Wait wait_ = ipc::Wait::futex;
  std::map<std::string, int, std::less<>> ring_fds_;
  std::map<std::string, ipc::Segment, std::less<>> mapped_;  ///< a spare's, not asked for yet
  std::unique_ptr<ipc::Writer<msg::StageMarks>> marks_;
  int ready_fd_ = -1;
  int standby_fd_ = -1;  ///< of a spare whose turn has not come
  std::int64_t last_beat_ns_ = 0;
  std::int64_t last_complaint_ns_ = 0;
  std::uint64_t complaints_ = 0;
};

/// What a daemon tells about itself: `--help`, `--version`, `--backends`.
struct Description {
  std::string_view name;                   ///< "camera"
  std::string_view summary;                ///< one sentence for --help
  std::vector<std::string_view> backends;  ///< names, in the order of the table
};

/// The main of every daemon: parses the command line, loads the rig, runs `body`, turns its errors
/// into exit codes.
int run(const Description& description, int argc, char** argv,
        const std::function<void(Context&)>& body);

}  // namespace handcast::service
