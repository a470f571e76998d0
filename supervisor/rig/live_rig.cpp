// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/live_rig.hpp"

#include "ipc/base/clock.hpp"
#include "ipc/daemon/contract.hpp"
#include "supervisor/spec/fingerprint.hpp"

namespace handcast::supervisor {

LiveRig::LiveRig(const config::Rig& rig, EventLoop& loop, Service::OnNotice on_notice)
    : name(rig.name),
      config(rig),
      started_ns(now_ns()),
      launch{.epoch_ns = started_ns},
      recorder(rig.supervisor.history_s),
      services(launch, loop, std::move(on_notice)) {
  take_settings(rig);
}

Result<daemon::Rings> LiveRig::make_rings(const std::vector<ServiceSpec>& specs) {
  auto made = rings.add(rings_of(specs));
  if (!made) return made;
  launch.rings = rings.descriptors();
  for (const auto& spec : specs)
    if (const auto fd = daemon::find_ring(launch.rings, daemon::marks_stream_of(spec.name)))
      if (auto followed = recorder.follow(spec.name, *fd); !followed)
        return fail_in("the recorder", followed.error());
  return made;
}

void LiveRig::use(AppliedRig rig) {
  applied = std::move(rig);
  launch.rig_fd = applied.file.get();
}

void LiveRig::take_settings(const config::Rig& rig) {
  launch.ready_s = rig.supervisor.ready_s;
  launch.stop_s = rig.supervisor.stop_s;
  launch.silent_s = rig.supervisor.silent_s;
  recorder.set_history(rig.supervisor.history_s);
}

Service::Look LiveRig::look_at(const Service& service, std::int64_t now) const {
  Service::Look look{.needs_are_ready = services.needs_are_ready(service)};
  if (stops())
    look.last_sign_ns = now;
  else if (const auto silence_ms = recorder.silence_ms(service.spec().name, now))
    look.last_sign_ns = now - ms_to_ns(*silence_ms);
  return look;
}

std::int64_t LiveRig::settled_by(std::int64_t now_ns) const {
  constexpr double kGrace_s = 1;
  return now_ns + seconds_to_ns(launch.stop_s + launch.ready_s + kGrace_s);
}

std::string LiveRig::text() const {
  config::Rig runs = config;
  for (const auto& service : services.all())
    runs = with_backend(std::move(runs), service->spec().name, service->spec().backend);
  return handcast::config::print_rig(runs);
}

RigView LiveRig::view() const {
  return {name,       services.all(), recorder,
          started_ns, now_ns(),       launch.keeper && launch.keeper->keeper_died()};
}

}  // namespace handcast::supervisor
