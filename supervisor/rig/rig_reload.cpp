// SPDX-License-Identifier: Apache-2.0
// `handcast reload`: the rig file is read again, and only what it changes is restarted.
#include <fmt/format.h>

#include <algorithm>

#include "config/settings/join.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "supervisor/rig/applied_rig.hpp"
#include "supervisor/rig/rig_runner.hpp"
#include "supervisor/spec/fingerprint.hpp"
#include "supervisor/spec/service_spec.hpp"

namespace handcast::supervisor {
namespace {

constexpr double kGrace_s =
    1;  ///< on top of the time that a service may take to stop and to be ready

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Whether the service needs a restart that its settings do not explain: what made it fail may be
/// mended.
bool has_given_up(const Service& service) {
  return service.state() == State::failed || service.state() == State::degraded;
}

bool has_settled(const Service& service) {
  return service.state() != State::starting && service.state() != State::stopping;
}

/// What differs between a ring and what the new settings ask for; empty if nothing does.
std::string difference(const ipc::Segment& ring, const ipc::RingSpec& wanted) {
  if (ring.slots() != wanted.slots)
    return fmt::format("{} slots, not {}", wanted.slots, ring.slots());
  if (ring.payload_bytes() != wanted.payload_bytes)
    return fmt::format("{} bytes a message, not {}", wanted.payload_bytes, ring.payload_bytes());
  return {};
}

}  // namespace

void RigRunner::reload(Result<config::Rig> rig, bool revives, ControlServer::Reply reply) {
  const auto refuse = [&](const std::string& sentence) {
    log::warning("not reloaded: {}", sentence);
    reply(failure(sentence));
  };
  if (const auto reason = why_not_reload(); !reason.empty()) return refuse(reason);
  if (!rig) return refuse(rig.error().what);
  const auto specs = services_of(with_swaps(*rig));
  if (const auto possible = check_change(*rig, specs); !possible)
    return refuse(possible.error().what);
  if (const auto applied = write_applied(*rig); !applied) return refuse(applied.error().what);
  const auto rings_before = static_cast<std::ptrdiff_t>(launch_.rings.size());
  if (const auto added = add_rings(specs); !added) return refuse(added.error().what);
  store_with_systemd({launch_.rings.begin() + rings_before, launch_.rings.end()});

  reload_.emplace();
  reload_->reply = std::move(reply);
  reload_->revives = revives;
  reload_->changed = config::print_rig(*rig) != config::print_rig(rig_);
  launch_.ready_s = rig->supervisor.ready_s;
  launch_.stop_s = rig->supervisor.stop_s;
  launch_.silent_s = rig->supervisor.silent_s;
  recorder_.remember(rig->supervisor.history_s);
  rig_ = std::move(*rig);
  apply(specs);
  save();
  continue_reload(now_ns());
}

std::string RigRunner::why_not_reload() const {
  if (phase_ == Phase::stopping || phase_ == Phase::done) return "the rig stops";
  if (reload_) return "the rig is being reloaded already";
  if (!pending_.empty())
    return pending_.begin()->first + " is being restarted; try again when that is done";
  return {};
}

config::Rig RigRunner::with_swaps(config::Rig rig) const {
  for (const auto& service : services_) {
    const auto& name = service->spec().name;
    const auto before = backend_of(name, rig_);
    const bool swapped = service->spec().backend != before;
    if (swapped && backend_of(name, rig) == before)
      rig = with_backend(std::move(rig), name, service->spec().backend);
  }
  return rig;
}

/// Whether a rig that is up can become this one. Errors: bad_config, with a sentence that says what
/// to do.
Result<void> RigRunner::check_change(const config::Rig& rig,
                                     const std::vector<ServiceSpec>& specs) const {
  if (rig.name != name_)
    return fail(Errc::bad_config, fmt::format("the rig's name cannot change while it is up ('{}' "
                                              "to '{}'); `handcast down --rig {}` and "
                                              "`handcast up` do that",
                                              name_, rig.name, name_));
  for (const auto& wanted : rings_of(specs))
    for (const auto& ring : rings_)
      if (const auto differs = difference(ring, wanted);
          ring.stream() == wanted.stream && !differs.empty())
        return fail(Errc::bad_config, fmt::format("ring '{}' would need {}: it cannot change while "
                                                  "the rig is up; `handcast down --rig {}` and "
                                                  "`handcast up` do that",
                                                  wanted.stream, differs, name_));
  for (const auto& spec : specs) {
    const auto service = find(spec.name);
    if (!service || service->spec().backend == spec.backend) continue;
    if (auto known = check_backend(spec.name, spec.backend); !known) return known;
  }
  return {};
}

Result<void> RigRunner::add_rings(const std::vector<ServiceSpec>& specs) {
  for (const auto& wanted : rings_of(specs)) {
    if (std::ranges::find(launch_.rings, wanted.stream,
                          [](const auto& ring) { return ring.first; }) != launch_.rings.end())
      continue;
    auto segment = make_ring(wanted);
    if (!segment) return fail_in(fmt::format("ring {}", wanted.stream), segment.error());
    launch_.rings.emplace_back(wanted.stream, segment->fd());
    rings_.push_back(std::move(*segment));
  }
  for (const auto& spec : specs)
    for (const auto& [stream, fd] : launch_.rings)
      if (stream == "marks." + spec.name)
        if (auto followed = recorder_.follow(spec.name, fd); !followed)
          return fail_in("the recorder", followed.error());
  return {};
}

void RigRunner::apply(const std::vector<ServiceSpec>& specs) {
  for (const auto& service : services_) {
    const auto& name = service->spec().name;
    if (std::ranges::find(specs, name, &ServiceSpec::name) == specs.end())
      reload_->stopped.push_back(name);
  }
  for (std::size_t place = 0; place < specs.size(); ++place) {
    const auto& spec = specs[place];
    const auto service = find(spec.name);
    if (!service) {
      add_service(spec, place);
      reload_->started.push_back(spec.name);
      continue;
    }
    const bool not_begun = !service->first_start_ns();
    const bool stale = service->spec().fingerprint != spec.fingerprint ||
                       (reload_->revives && has_given_up(*service));
    service->update(spec);
    if (stale && !not_begun) reload_->restarted.push_back(spec.name);
  }
  reload_->waiting = reload_->restarted;
  reload_->waiting.insert(reload_->waiting.end(), reload_->started.begin(), reload_->started.end());
  for (const auto& name : reload_->stopped) find(name)->stop();
}

void RigRunner::add_service(const ServiceSpec& spec, std::size_t place) {
  const auto at =
      services_.begin() + static_cast<std::ptrdiff_t>(std::min(place, services_.size()));
  services_.insert(
      at, std::make_unique<Service>(spec, launch_, loop_, [this](Service& service, Notice notice) {
        on_notice(service, notice);
      }));
}

void RigRunner::continue_reload(std::int64_t now) {
  if (!reload_) return;
  settle(now);
  begin_what_may(now);
  const bool gone = std::ranges::all_of(
      reload_->stopped, [this](const auto& name) { return find(name)->state() == State::stopped; });
  if (gone && reload_->waiting.empty() && reload_->begun.empty()) answer_reload();
}

/// A service begins when nothing that it needs is still to begin or to settle.
void RigRunner::begin_what_may(std::int64_t now) {
  const auto until_ns = now + seconds_to_ns(launch_.stop_s + launch_.ready_s + kGrace_s);
  for (const auto& name : std::vector<std::string>(reload_->waiting)) {
    const auto& service = find(name);
    const auto in_the_way = [&](const auto& need) {
      return contains(reload_->waiting, need) || reload_->begun.contains(need);
    };
    if (std::ranges::any_of(service->spec().needs, in_the_way)) continue;
    std::erase(reload_->waiting, name);
    reload_->begun[name] = until_ns;
    service->restart();
  }
}

void RigRunner::settle(std::int64_t now) {
  for (auto begun = reload_->begun.begin(); begun != reload_->begun.end();) {
    const auto& [name, until_ns] = *begun;
    const auto& service = *find(name);
    if (!has_settled(service) && now < until_ns) {
      ++begun;
      continue;
    }
    if (service.state() != State::ready)
      reload_->failures.push_back(fmt::format("{} is {} with the new settings: {}", name,
                                              name_of(service.state()),
                                              service.log().last_sentence()));
    begun = reload_->begun.erase(begun);
  }
}

void RigRunner::answer_reload() {
  auto reload = *std::exchange(reload_, {});
  std::erase_if(services_, [&](const auto& service) {
    return contains(reload.stopped, service->spec().name);
  });
  auto answer = reload.failures.empty() ? success() : failure(config::join(reload.failures, "\n"));
  answer["changed"] = reload.changed;
  answer["restarted"] = reload.restarted;
  answer["started"] = reload.started;
  answer["stopped"] = reload.stopped;
  answer["untouched"] = nlohmann::json::array();
  for (const auto& service : services_) {
    const auto& name = service->spec().name;
    if (!contains(reload.restarted, name) && !contains(reload.started, name))
      answer["untouched"].push_back(name);
  }
  log::info("rig '{}' reloaded; restarted: {}", name_,
            reload.restarted.empty() ? "nothing" : config::join(reload.restarted, ", "));
  save();
  reload.reply(answer);
}

}  // namespace handcast::supervisor
