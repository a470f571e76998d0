// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before the definition of a free function with plain loops: the compiler makes one version per
/// instruction set and the loader picks the best the processor has. Off under sanitizers, whose
/// runtime is not up yet when the loader picks.
#if defined(HANDCAST_WITH_SANITIZER) || !defined(__x86_64__)
#define HANDCAST_CLONES
#else
#define HANDCAST_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
