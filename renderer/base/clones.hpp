// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Precedes the definition of a free function with plain loops: the compiler makes one version per
/// instruction set, and the loader picks the best one that the processor supports. Empty under
/// sanitizers, whose runtime is not initialised when the loader picks, and on other processors than
/// x86-64.
#if defined(HANDCAST_WITH_SANITIZER) || !defined(__x86_64__)
#define HANDCAST_CLONES
#else
#define HANDCAST_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
