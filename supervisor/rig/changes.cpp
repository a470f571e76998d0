// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/changes.hpp"

#include <fmt/format.h>

#include <utility>

#include "supervisor/spec/fingerprint.hpp"

namespace handcast::supervisor {
namespace {

nlohmann::json success_of(const Service& service) {
  auto answer = control::success();
  if (const auto pause_ms = service.pause_ms()) answer["pause_ms"] = *pause_ms;
  return answer;
}

}  // namespace

void Changes::restart(Service& service, ControlServer::Reply reply) {
  auto& pending = pending_[service.spec().name] = {std::move(reply)};
  if (!service.works()) return service.restart();
  replace(service, service.spec().backend, pending);
}

void Changes::swap(Service& service, const std::string& backend, ControlServer::Reply reply) {
  const auto name = service.spec().name;
  if (const auto known = check_backend(rig_.catalogue, name, backend); !known)
    return reply(control::failure(known.error().what));
  auto& pending = pending_[name] = {std::move(reply), backend, service.spec().backend};
  if (!service.works()) return give_backend(service, backend, true);
  replace(service, backend, pending);
}

/// Prepares a replacement. A standby that was started with the same settings is one already.
void Changes::replace(Service& service, const std::string& backend, Pending& pending) {
  const auto& name = service.spec().name;
  const bool is_swap = !pending.wanted.empty();
  auto wanted = service.settings();
  wanted.spec.backend = backend;
  wanted.spec.fingerprint =
      fingerprint_of(name, with_backend(rig_.config, name, backend), rig_.catalogue);
  if (is_swap) wanted.swapped = backend;
  const bool is_same = !is_swap && wanted.spec.fingerprint == service.spec().fingerprint;
  const bool alone = is_exclusive(rig_.catalogue, name, service.spec().backend) &&
                     is_exclusive(rig_.catalogue, name, backend);
  pending.is_replacing = true;
  service.prepare(std::move(wanted), {.on_trial = is_swap, .alone = alone}, is_same);
  if (service.replacement_is_prepared()) hand_over(service, pending);
}

void Changes::hand_over(Service& service, Pending& pending) {
  pending.is_replacing = false;
  service.hand_over();
}

void Changes::tick() {
  for (auto next = pending_.begin(); next != pending_.end();) {
    const auto found = next++;
    auto& [name, pending] = *found;
    if (!pending.is_replacing) continue;
    auto& service = *rig_.services.find(name);
    if (service.replacement_is_prepared()) {
      hand_over(service, pending);
    } else if (!service.has_replacement()) {
      const auto what = pending.wanted.empty()
                            ? fmt::format("{} was not restarted", name)
                            : fmt::format("{} did not start with '{}'", name, pending.wanted);
      const auto old =
          pending.before.empty() ? "the old process" : fmt::format("'{}'", pending.before);
      const auto rest = old + (service.works() ? " goes on" : " does not work either");
      const auto sentence = fmt::format("{}, {}: {}", what, rest, service.replacement_problem());
      pending_.extract(found).mapped().reply(control::failure(sentence));
    }
  }
}

/// Restarts a service with another back end and updates its fingerprint.
void Changes::give_backend(Service& service, const std::string& backend, bool on_trial) {
  auto spec = service.spec();
  spec.fingerprint =
      fingerprint_of(spec.name, with_backend(rig_.config, spec.name, backend), rig_.catalogue);
  service.update(spec);
  service.use_backend(backend, on_trial);
}

bool Changes::is_replacing(const Service& service) const {
  const auto found = pending_.find(service.spec().name);
  return found != pending_.end() && found->second.is_replacing;
}

void Changes::on_ready(const Service& service) {
  if (is_replacing(service)) return;  // the old worker died and was started again
  const auto pending = pending_.extract(service.spec().name);
  if (!pending) return;
  const auto& name = pending.key();
  const auto& change = pending.mapped();
  if (!change.reason.empty())
    change.reply(
        control::failure(fmt::format("{} did not start with '{}', '{}' was started again: {}", name,
                                     change.wanted, change.before, change.reason)));
  else if (!service.replacement_problem().empty())
    change.reply(
        control::failure(fmt::format("the new process of {} failed, and the old one had "
                                     "stopped and was started again: {}",
                                     name, service.replacement_problem())));
  else
    change.reply(success_of(service));
}

void Changes::on_stopped(const Service& service) {
  if (is_replacing(service)) return;
  if (const auto pending = pending_.extract(service.spec().name))
    pending.mapped().reply(control::failure(pending.key() + " ended by itself"));
}

bool Changes::on_failed(Service& service) {
  const auto found = pending_.find(service.spec().name);
  if (found == pending_.end()) return false;
  if (found->second.is_replacing) return true;
  const auto sentence = service.log().last_sentence();
  auto& pending = found->second;
  if (!pending.wanted.empty() && pending.reason.empty()) {
    pending.reason = sentence;
    give_backend(service, pending.before, false);
    return true;
  }
  pending_.extract(found).mapped().reply(
      control::failure(fmt::format("{} failed: {}", service.spec().name, sentence)));
  return false;
}

void Changes::refuse_all(const std::string& sentence) {
  for (const auto& [name, pending] : std::exchange(pending_, {}))
    pending.reply(control::failure(sentence));
}

}  // namespace handcast::supervisor
