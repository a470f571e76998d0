// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace handcast::pose::leapc {

/// Copies memory of this process that another library points to. Returns false, instead of ending
/// the process, if it is not readable. Any thread.
bool copy_memory(const void* from, void* to, std::size_t bytes);

/// The same for one structure.
template <class T>
bool copy_memory(const T* from, T& to) {
  return copy_memory(from, &to, sizeof to);
}

}  // namespace handcast::pose::leapc
