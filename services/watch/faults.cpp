// SPDX-License-Identifier: Apache-2.0
#include "services/watch/faults.hpp"

#include <fmt/format.h>

#include <array>

#include "ipc/base/clock.hpp"

namespace handcast::watch {
namespace {

/// A service that dies so often within this time dies again and again, even if the supervisor,
/// which looks at a minute, does not call it degraded.
constexpr std::size_t kManyRestarts = 5;
constexpr std::int64_t kWithin_ns = 600'000'000'000;
constexpr std::int64_t kNoAnswer_ns = 30'000'000'000;

struct Sensor {
  const char *stream, *service, *what;
};
constexpr std::array kSensors{
    Sensor{"camera.frames", "camera", "the camera has sent no image"},
    Sensor{"camera2.frames", "camera2", "the second camera has sent no image"},
    Sensor{"pose.hands", "pose", "the tracker has sent no sample"},
    Sensor{"landmarks.hands", "landmarks", "the detector has searched no image"},
    Sensor{"landmarks2.hands", "landmarks2", "the second detector has searched no image"},
    Sensor{"projection.frames", "projector", "the projector has shown no frame"},
    Sensor{"projection2.frames", "projector2", "the second projector has shown no frame"}};

std::string because(const std::string& reason) { return reason.empty() ? "" : ": " + reason; }

}  // namespace

void FaultFinder::look_at(const std::string& name, const RigStatus::Service& service,
                          std::int64_t now_ns, Wrongs& wrongs) {
  auto [entry, is_new] = services_.try_emplace(name, Service{service.restarts, {}});
  auto& seen = entry->second;
  const bool has_died = service.restarts > seen.restarts;
  for (; seen.restarts < service.restarts; ++seen.restarts) {
    seen.restarted_ns.push_back(now_ns);
    if (seen.restarted_ns.size() > kManyRestarts) seen.restarted_ns.pop_front();
  }
  seen.restarts = service.restarts;
  const bool dies_often = has_died && seen.restarted_ns.size() == kManyRestarts &&
                          now_ns - seen.restarted_ns.front() < kWithin_ns;
  auto& sentence = wrongs["service " + name];
  if (service.state == "failed")
    sentence = fmt::format("service {} has been given up{}", name, because(service.reason));
  else if (service.state == "degraded" || dies_often)
    sentence = fmt::format("service {} dies again and again{}", name, because(service.reason));
  else
    wrongs.erase("service " + name);
}

void FaultFinder::listen(const std::string& stream, std::uint64_t messages, bool must_send,
                         std::int64_t now_ns, Wrongs& wrongs) {
  auto [entry, is_new] = rings_.try_emplace(stream, Ring{messages, now_ns});
  auto& ring = entry->second;
  if (ring.messages != messages || !must_send) ring = {messages, now_ns};
  const auto silent_s = ns_to_seconds(now_ns - ring.heard_ns);
  if (silent_s < settings_.silent_s) return;
  for (const auto& sensor : kSensors)
    if (stream == sensor.stream)
      wrongs["silent " + stream] =
          fmt::format("{} for {:.0f} s, though its service runs", sensor.what, silent_s);
}

Wrongs FaultFinder::find(const RigStatus& status, const Seen& seen) {
  Wrongs wrongs;
  answered_ns_ = seen.now_ns;
  for (const auto& [name, service] : status.services) look_at(name, service, seen.now_ns, wrongs);
  for (const auto& sensor : kSensors) {
    const auto ring = status.messages.find(sensor.stream);
    const auto service = status.services.find(sensor.service);
    if (ring == status.messages.end() || service == status.services.end()) continue;
    const bool must_send = service->second.state == "ready" && !seen.is_switched_off;
    listen(ring->first, ring->second, must_send, seen.now_ns, wrongs);
  }
  if (seen.disk_free_gb < settings_.disk_gb)
    wrongs["disk"] = fmt::format("the disk is nearly full: {:.1f} GB are free", seen.disk_free_gb);
  return wrongs;
}

Wrongs FaultFinder::find_without_status(std::int64_t now_ns) {
  if (answered_ns_ == 0) answered_ns_ = now_ns;
  if (now_ns - answered_ns_ < kNoAnswer_ns) return {};
  return {{"supervisor", fmt::format("the supervisor has not answered for {:.0f} s",
                                     ns_to_seconds(now_ns - answered_ns_))}};
}

}  // namespace handcast::watch
