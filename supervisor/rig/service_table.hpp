// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "supervisor/life/service.hpp"

namespace handcast::supervisor {

using Services = std::vector<std::unique_ptr<Service>>;

/// The services of a rig, in an order in which each needs only those before it.
class ServiceTable {
 public:
  /// `launch` and `loop` must outlive the object.
  ServiceTable(const Launch& launch, EventLoop& loop, Service::OnNotice on_notice);

  /// Adds a service at a place of the order, or behind all others if the order is shorter.
  Service& add(ServiceSpec spec, std::size_t place);
  Service& add(ServiceSpec spec) { return add(std::move(spec), services_.size()); }
  /// A service that runs is killed.
  void remove(std::string_view name);
  /// Null if there is no such service.
  Service* find(std::string_view name) const;
  const Services& all() const { return services_; }

  /// Whether all that a service needs is ready.
  bool needs_are_ready(const Service& service) const;
  /// The first service that is held and waits for nothing any more; null if there is none. A need
  /// is not waited for once it is ready, has given up, or has had its time (ready_s).
  Service* next_to_begin(std::int64_t now_ns) const;
  /// Whether each service has been ready, or need not be waited for.
  bool has_come_up(std::int64_t now_ns) const;
  /// The last service in the order that has a process; null if none has.
  Service* last_running() const;

  /// Counts up whenever Service::saved() of one of them may have changed.
  std::uint64_t revision() const;

 private:
  bool need_not_be_waited_for(const Service& service, std::int64_t now_ns) const;

  const Launch& launch_;
  EventLoop& loop_;
  Service::OnNotice on_notice_;
  Services services_;
  std::uint64_t revision_ = 0;  ///< of the table itself, and of the services that were removed
};

}  // namespace handcast::supervisor
