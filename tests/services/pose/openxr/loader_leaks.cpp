// SPDX-License-Identifier: Apache-2.0
// The loader keeps 1.3 kB of each instance that was destroyed (1.0.20). A pose service has one
// instance in its life.
extern "C" const char* __lsan_default_suppressions() { return "leak:libopenxr_loader"; }
