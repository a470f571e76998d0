// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::test {

/// Whether this process and its children see emulated devices: it was started by umockdev-wrapper.
bool sees_emulated_devices();
/// Starts this program again under umockdev-wrapper. Returns if that is not installed, or if it has
/// been done.
void see_emulated_devices(char** argv);

}  // namespace handcast::test
