// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/changes.hpp"

#include <fmt/format.h>

#include <utility>

#include "supervisor/rig/present_backend.hpp"
#include "supervisor/spec/fingerprint.hpp"

namespace handcast::supervisor {

void Changes::restart(Service& service, ControlServer::Reply reply) {
  pending_[service.spec().name] = {std::move(reply)};
  service.restart();
}

void Changes::swap(Service& service, const std::string& word, ControlServer::Reply reply) {
  const auto name = service.spec().name;
  const auto backend = present_backend(name, word, rig_.config);
  if (!backend) return reply(control::failure(backend.error().what));
  if (const auto known = check_backend(rig_.catalogue, name, *backend); !known)
    return reply(control::failure(known.error().what));
  pending_[name] = {std::move(reply), *backend, service.spec().backend};
  give_backend(service, *backend, true);
}

/// Restarts a service with another back end and updates its fingerprint.
void Changes::give_backend(Service& service, const std::string& backend, bool on_trial) {
  auto spec = service.spec();
  spec.fingerprint =
      fingerprint_of(spec.name, with_backend(rig_.config, spec.name, backend), rig_.catalogue);
  service.update(spec);
  service.use_backend(backend, on_trial);
}

void Changes::on_ready(const Service& service) {
  const auto pending = pending_.extract(service.spec().name);
  if (!pending) return;
  const auto& [reply, wanted, before, reason] = pending.mapped();
  reply(reason.empty()
            ? control::success()
            : control::failure(fmt::format("{} did not start with '{}', '{}' goes on: {}",
                                           pending.key(), wanted, before, reason)));
}

void Changes::on_stopped(const Service& service) {
  if (const auto pending = pending_.extract(service.spec().name))
    pending.mapped().reply(control::failure(pending.key() + " ended by itself"));
}

bool Changes::on_failed(Service& service) {
  const auto found = pending_.find(service.spec().name);
  if (found == pending_.end()) return false;
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
