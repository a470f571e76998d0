// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "supervisor/life/child.hpp"

namespace handcast::supervisor {

/// The option with which `handcast` becomes the process of a DescriptorStore.
inline constexpr const char* kHoldOption = "--hold";

/// A process that only keeps the descriptors of a rig open, under their numbers, for a successor of
/// the supervisor. It exists while a service has capabilities: the kernel hides the descriptors of
/// such a service from its user's other processes. The process itself has none. It is found like a
/// service (find_services()), outlives the supervisor and ends with the object.
class DescriptorStore {
 public:
  /// Keeps the rings and the state of `spec` and its `kept_open` for these living services. Starts
  /// another process if the descriptors have changed or the process has ended. `spec.program`: that
  /// of `handcast`.
  void keep(ChildSpec spec, const std::vector<pid_t>& services);
  /// True if the process has ended by itself.
  bool has_ended() const { return process_ && process_->has_ended(); }
  /// Ends the process.
  void close() { process_.reset(); }

 private:
  std::unique_ptr<Child> process_;
  std::vector<std::uint64_t> inodes_;  ///< of what it keeps
  bool has_failed_ = false;
};

/// What the process of a DescriptorStore does: gives up all capabilities and waits until it is
/// ended.
[[noreturn]] void hold_descriptors();

}  // namespace handcast::supervisor
