// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "config/live/live_board.hpp"
#include "config/sections/viewpoint.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/msg/projection.hpp"
#include "services/tools/preview/layout/gauges.hpp"
#include "services/tools/preview/scene/scene_maker.hpp"
#include "services/tools/preview/status_gauges.hpp"

namespace handcast::preview {

/// What the preview reads of a running rig: the newest messages of its rings, by watching readers
/// that take no place in them, and the status of its supervisor. One thread.
class RigFeed {
 public:
  /// Time between two calls of look().
  static constexpr std::int64_t kPeriod_ns = 33'000'000;

  /// Opens the rings of a rig, and the light of one of its projectors; an empty name means the only
  /// one that is up. Errors: unavailable (no such rig), bad_config (it has none of the four
  /// streams, or no second projector), bad_data (another version).
  static Result<RigFeed> open(const std::string& rig,
                              config::Viewpoint projector = config::Viewpoint::first);

  /// Takes the newest light and the image it was made from, and all new poses and landmarks. Does
  /// not wait for messages; waits at most 0.1 s for a supervisor that hangs. Errors: disconnected
  /// (the rig is down).
  Result<void> look();
  /// The scene of the last look() but one, whose motion is known by now. If that was too long ago,
  /// of the last one.
  Scene scene();
  /// The figures up to now.
  Gauges gauges() const;
  /// Name of the rig, and whose light is shown.
  /// @{
  const std::string& rig() const { return rig_; }
  config::Viewpoint projector() const { return projector_; }
  /// @}

 private:
  /// One stream; absent if the rig does not have it.
  template <class T>
  struct Input {
    std::optional<client::Stream<T>> stream;
    RateMeter meter;
    Series held_hz{kRates};
  };
  /// An image and the light that was made from it.
  struct Pair {
    std::optional<ipc::Sample<msg::CameraFrame>> frame;
    std::optional<ipc::Sample<msg::Projection>> projection;
  };
  static constexpr std::size_t kRates = 120, kAges = 300;
  static constexpr std::int64_t kRate_ns = 500'000'000, kChange_ns = 2'000'000'000;

  RigFeed(std::string rig, config::Viewpoint projector)
      : rig_(std::move(rig)), projector_(projector) {}
  void learn_world();
  void learn_changes();
  void learn_light();
  template <class T>
  Result<void> open_input(std::string_view name, Input<T>& input);
  Result<void> take_pair();
  template <class T>
  Result<void> take_all(Input<T>& input);
  void take_ages(const msg::Projection& projection);
  double age_period_s() const;
  void take_rates();
  void ask_status();

  std::string rig_;
  config::Viewpoint projector_;
  std::vector<std::string> missing_;  ///< sentences about what is not shown
  std::string applied_;               ///< the settings that the world was made from, TOML
  std::string no_world_;              ///< why the rig's settings are not known; empty if they are
  std::string dark_;                  ///< why the light is off; empty if it is on
  std::string silent_;                ///< why the supervisor does not answer; empty if it does
  std::unique_ptr<SceneMaker> maker_;
  std::optional<config::LiveBoard> board_;  ///< empty: the settings are those of the file
  std::optional<std::uint64_t> dimmed_by_;  ///< the change after which learn_light() looked
  Input<msg::CameraFrame> camera_;
  Input<msg::HandPoses> poses_;
  Input<msg::Landmarks> landmarks_;
  Input<msg::Projection> light_;
  Pair newest_, shown_;
  std::array<Series, 3> ages_ms_{Series(kAges), Series(kAges), Series(kAges)};
  nlohmann::json status_;
  std::deque<std::int64_t> age_times_;  ///< when ages were added, oldest first
  std::int64_t next_rate_ns_ = 0, next_change_ns_ = 0;
  std::int64_t looked_ns_ = 0;  ///< the last look()
};

}  // namespace handcast::preview
