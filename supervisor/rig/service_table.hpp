// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "supervisor/life/service.hpp"

namespace handcast::supervisor {

/// Services, each with a fixed address.
using Services = std::vector<std::unique_ptr<Service>>;

/// The services of a rig, in an order in which each needs only those before it.
class ServiceTable {
 public:
  /// `launch` and `loop` must outlive the object.
  ServiceTable(const Launch& launch, EventLoop& loop, Service::OnNotice on_notice);

  /// Adds a service at position `place`, or at the end if the table is shorter.
  Service& add(ServiceSpec spec, std::size_t place);
  /// Adds a service at the end.
  Service& add(ServiceSpec spec) { return add(std::move(spec), services_.size()); }
  /// Removes a service. Kills its processes.
  void remove(std::string_view name);
  /// The service of this name; null if there is none.
  Service* find(std::string_view name) const;
  /// All services in their order.
  const Services& all() const { return services_; }

  /// True if all services that this one needs are ready.
  bool needs_are_ready(const Service& service) const;
  /// The first held service whose needs are met; null if there is none. A need is met if its
  /// service is ready, has given up, was started more than ready_s ago, or was started and has not
  /// its own needs.
  Service* next_to_begin(std::int64_t now_ns) const;
  /// True if each service has been ready, has given up, or was started more than ready_s ago.
  bool has_come_up(std::int64_t now_ns) const;
  /// The last service that has a process, a guest only if no other has: what it feeds would say
  /// that nothing comes. Null if none has.
  Service* next_to_stop() const;

  /// Incremented whenever Service::saved() of a service may have changed.
  std::uint64_t revision() const;

 private:
  bool need_not_be_waited_for(const Service& service, std::int64_t now_ns) const;

  const Launch& launch_;
  EventLoop& loop_;
  Service::OnNotice on_notice_;
  Services services_;
  std::uint64_t revision_ = 0;  ///< of the table itself and of removed services
};

}  // namespace handcast::supervisor
