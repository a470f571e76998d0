// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/service_table.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {

ServiceTable::ServiceTable(const Launch& launch, EventLoop& loop, Service::OnNotice on_notice)
    : launch_(launch), loop_(loop), on_notice_(std::move(on_notice)) {}

Service& ServiceTable::add(ServiceSpec spec, std::size_t place) {
  const auto at =
      services_.begin() + static_cast<std::ptrdiff_t>(std::min(place, services_.size()));
  ++revision_;
  return **services_.insert(at,
                            std::make_unique<Service>(std::move(spec), launch_, loop_, on_notice_));
}

void ServiceTable::remove(std::string_view name) {
  const auto is_it = [&](const auto& service) { return service->spec().name == name; };
  const auto found = std::ranges::find_if(services_, is_it);
  if (found == services_.end()) return;
  revision_ += (*found)->revision() + 1;
  services_.erase(found);
}

Service* ServiceTable::find(std::string_view name) const {
  const auto is_it = [&](const auto& service) { return service->spec().name == name; };
  const auto found = std::ranges::find_if(services_, is_it);
  return found == services_.end() ? nullptr : found->get();
}

bool ServiceTable::needs_are_ready(const Service& service) const {
  return std::ranges::all_of(service.spec().needs, [this](const auto& name) {
    const auto* need = find(name);
    return !need || need->state() == State::ready;
  });
}

Service* ServiceTable::next_to_begin(std::int64_t now) const {
  const auto waits_for = [&](const auto& name) {
    const auto* need = find(name);
    return need && !need_not_be_waited_for(*need, now);
  };
  for (const auto& service : services_)
    if (service->is_held() && std::ranges::none_of(service->spec().needs, waits_for))
      return service.get();
  return nullptr;
}

bool ServiceTable::has_come_up(std::int64_t now) const {
  return std::ranges::all_of(services_, [&](const auto& service) {
    return service->was_ready() || need_not_be_waited_for(*service, now);
  });
}

/// One that was begun without its own needs, because their time was over, gets no time of its own.
bool ServiceTable::need_not_be_waited_for(const Service& service, std::int64_t now) const {
  if (service.state() != State::starting && service.state() != State::stopping) return true;
  if (!service.first_start_ns()) return false;
  return !needs_are_ready(service) ||
         now - *service.first_start_ns() > seconds_to_ns(launch_.ready_s);
}

Service* ServiceTable::next_to_stop() const {
  Service* guest = nullptr;
  for (auto service = services_.rbegin(); service != services_.rend(); ++service) {
    if (!(*service)->is_running()) continue;
    if ((*service)->spec().instance_of != "guest") return service->get();
    if (!guest) guest = service->get();
  }
  return guest;
}

std::uint64_t ServiceTable::revision() const {
  auto revision = revision_;
  for (const auto& service : services_) revision += service->revision();
  return revision;
}

}  // namespace handcast::supervisor
