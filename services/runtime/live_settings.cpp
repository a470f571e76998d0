// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/live_settings.hpp"

#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <utility>

#include "config/live/live_values.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/ring/reader.hpp"

namespace handcast::service {
namespace {

using namespace std::chrono_literals;
using Reader = ipc::Reader<msg::LiveSettings>;

/// Empty if the values do not fit to the file.
std::unique_ptr<LiveRig> rig_of(const config::Rig& filed, const msg::LiveSettings& settings) {
  auto rig = config::with_live(filed, settings.values.view());
  if (rig) return std::make_unique<LiveRig>(LiveRig{std::move(*rig), settings});
  log::warning("the live settings are left out: {}", rig.error().what);
  return nullptr;
}

/// Below the priority of the service: a frame must not wait for it, however often settings change.
/// (nice(2) is of one thread in Linux.)
void lower_priority() {
  const sched_param none{};
  if (pthread_setschedparam(pthread_self(), SCHED_OTHER, &none) != 0 || ::nice(5) == -1)
    log::debug("the priority of the thread for live settings cannot be lowered");
}

}  // namespace

LiveRig LiveSettings::newest(const config::Rig& filed, ipc::Segment ring) {
  auto reader = Reader::watch(std::move(ring));
  if (!reader) return {filed, {}};
  const auto last = reader->latest(Deadline::now());
  if (!last) return {filed, {}};
  auto live = rig_of(filed, **last);
  return live ? std::move(*live) : LiveRig{filed, **last};
}

Result<std::unique_ptr<LiveSettings>> LiveSettings::follow(const config::Rig& filed,
                                                           ipc::Segment ring) {
  auto reader = Reader::attach(std::move(ring), ipc::Wait::futex);
  if (!reader) return tl::make_unexpected(reader.error());
  std::unique_ptr<LiveSettings> live(new LiveSettings);
  live->thread_ = std::jthread([&fresh = live->fresh_, filed,
                                reader = std::move(*reader)](const std::stop_token& stop) mutable {
    lower_priority();
    std::string told;  // what is wrong with the ring for good
    while (!stop.stop_requested()) {
      const auto last = reader.latest(Deadline::in(200ms));
      if (!last) {
        if (last.error().code == Errc::timeout) continue;
        if (std::exchange(told, last.error().what) != told) log::warning("live settings: {}", told);
        sleep_until_ns(now_ns() + to_ns(200ms));
        continue;
      }
      if (auto rig = rig_of(filed, **last))
        delete fresh.exchange(rig.release(), std::memory_order_acq_rel);
    }
  });
  return live;
}

LiveSettings::~LiveSettings() {
  thread_ = {};
  delete fresh_.load();
}

}  // namespace handcast::service
