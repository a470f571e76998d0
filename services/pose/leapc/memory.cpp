// SPDX-License-Identifier: Apache-2.0
#include "services/pose/leapc/memory.hpp"

#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace handcast::pose::leapc {

// The kernel copies and checks the address on the way. Where a sandbox forbids the call, the
// pointer is trusted.
bool copy_memory(const void* from, void* to, std::size_t bytes) {
  if (!from) return false;
  const iovec here{to, bytes};
  const iovec there{const_cast<void*>(from), bytes};
  const ssize_t copied = ::process_vm_readv(::getpid(), &here, 1, &there, 1, 0);
  if (copied == static_cast<ssize_t>(bytes)) return true;
  if (copied >= 0 || (errno != EPERM && errno != ENOSYS)) return false;
  std::memcpy(to, from, bytes);
  return true;
}

}  // namespace handcast::pose::leapc
