// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

namespace handcast {

/// Maps the memory that this process has: code, data, heap, and 256 KiB of the calling thread's
/// stack. The first use of a page then raises no page fault. Needs no privilege; unlike a lock
/// (process.lock_memory), it does not keep the system from taking pages back. Call it after the
/// start, before the first frame. Mappings of more than 256 MiB are left out: they are reserved,
/// not used. Does nothing before Linux 5.14, and with sanitizers. Returns the number of bytes that
/// are mapped now, or were before.
std::size_t prefault_memory();

}  // namespace handcast
