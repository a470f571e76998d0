// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/lamp.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "ipc/base/log.hpp"
#include "services/desk/controls/complaints.hpp"
#include "services/desk/controls/control_value.hpp"
#include "services/desk/lamp/pjlink.hpp"

namespace handcast::desk {
namespace {

constexpr std::int64_t kLookEvery_ns = 100'000'000;

/// Follows a setting of the panel. The thread has the last word: what is wanted may change while it
/// talks to the projector.
class LampSurface final : public Surface {
 public:
  LampSurface(lamp::Place place, std::string input, Panel& panel, const LampPatience& patience)
      : place_(std::move(place)),
        input_(std::move(input)),
        panel_(panel),
        control_(find_control(panel.controls(), "light.lamp")),
        patience_(patience),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void turn(const Scene& scene) override {
    if (!control_ || scene.now_ns < next_look_ns_) return;
    next_look_ns_ = scene.now_ns + kLookEvery_ns;
    const auto value = number_of(panel_.controls()[*control_], panel_.values()->toml[*control_]);
    const auto wanted = static_cast<config::Lamp>(static_cast<int>(value.value_or(0)));
    if (std::exchange(seen_, wanted) == wanted) return;
    const std::lock_guard lock(mutex_);
    wanted_ = wanted;
    changed_.notify_one();
  }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, stop, [this] { return wanted_.has_value(); });
      const auto wanted = std::exchange(wanted_, std::nullopt);
      lock.unlock();
      if (wanted) go_to(*wanted, stop);
    }
  }

  /// Until the lamp is so, or is to be otherwise.
  void go_to(config::Lamp wanted, const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const auto done = lamp::tell(place_, wanted, input_, Deadline::in(patience_.answer), stop);
      if (stop.stop_requested()) return;
      if (!done) complaints_.add(now_ns(), done.error().what);
      if (done && *done && wanted != config::Lamp::unchanged)
        log::info("the projector's lamp: {}",
                  config::words_of(wanted)[static_cast<std::size_t>(wanted)]);
      if ((done && *done) || (!done && done.error().code == Errc::bad_config)) return;
      std::unique_lock lock(mutex_);
      if (changed_.wait_for(lock, stop, patience_.again, [this] { return wanted_.has_value(); }))
        return;
    }
  }

  const lamp::Place place_;
  const std::string input_;
  Panel& panel_;
  const std::optional<std::size_t> control_;
  const LampPatience patience_;
  config::Lamp seen_ = config::Lamp::unchanged;
  std::int64_t next_look_ns_ = 0;
  Complaints complaints_{"lamp"};  ///< of the thread
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<config::Lamp> wanted_;  ///< under mutex_: not yet taken by the thread
  std::jthread thread_;                 ///< the last member: it uses all others
};

}  // namespace

Result<std::unique_ptr<Surface>> open_lamp(const config::Rig& rig, Panel& panel,
                                           const LampPatience& patience) {
  const auto& settings = rig.projector.lamp;
  if (settings.pjlink.empty()) return nullptr;
  auto place = lamp::place_of(settings);
  if (!place) return tl::make_unexpected(place.error());
  return std::make_unique<LampSurface>(std::move(*place), settings.input, panel, patience);
}

}  // namespace handcast::desk
