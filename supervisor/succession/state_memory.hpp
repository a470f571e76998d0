// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "supervisor/succession/saved_rig.hpp"

namespace handcast::supervisor {

/// The name of the memory in systemd's store.
inline constexpr const char* kStateName = "supervisor.state";

/// The memory in which a supervisor saves its rig for a successor: a memfd that all services hold
/// open. It has no name in the file system, and its pages are reserved from the start, so that
/// saving does not fail when a folder is removed or a disk is full.
///
/// It has two slots, of which one is valid. save() writes to the other one and then makes it valid,
/// so that a supervisor that is killed meanwhile leaves the previous state.
class StateMemory {
 public:
  /// Reserves the memory. Errors: unavailable.
  static Result<StateMemory> create();
  /// Maps the memory of another process. Errors: bad_data (the file is something else).
  static Result<StateMemory> open(UniqueFd file);
  /// `other` has no memory afterwards.
  /// @{
  StateMemory(StateMemory&& other) noexcept;
  StateMemory& operator=(StateMemory&& other) noexcept;
  /// @}
  ~StateMemory();

  /// The descriptor that services inherit.
  int fd() const { return file_.get(); }
  /// Saves the rig. Errors: unavailable (it is too large); the previous state stays.
  Result<void> save(const SavedRig& rig);
  /// Afterwards nothing is saved: the rig has stopped, but systemd may have stored the memory.
  void forget();
  /// The saved rig. Errors: bad_data (none was saved, or as parse_saved()).
  Result<SavedRig> load(const std::string& name) const;

 private:
  struct Layout;
  StateMemory(UniqueFd file, Layout* layout);
  void unmap();

  UniqueFd file_;
  Layout* layout_ = nullptr;
};

}  // namespace handcast::supervisor
