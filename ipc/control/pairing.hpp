// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/control/desk_address.hpp"

/// The code that a person reads off this computer and types into the page on another one.
/// `handcast desk --lan` writes it into a file beside that of control::desk_file(); the desk takes
/// it from there.
namespace handcast::control {

inline constexpr std::int64_t kPairingLasts_ns = 300'000'000'000;  ///< how long a code is valid

struct Pairing {
  std::string code;           ///< 8 digits
  Role role = Role::viewer;   ///< what the one who knows it may do
  std::int64_t until_ns = 0;  ///< CLOCK_MONOTONIC
};

/// A fresh one, from the kernel's random numbers.
Pairing new_pairing(Role role);

/// Its file; `desk_file`: control::desk_file().
std::filesystem::path pairing_file(std::filesystem::path desk_file);
/// Replaces the code before. Errors: unavailable.
Result<void> write_pairing(const std::filesystem::path& file, const Pairing& pairing);
/// The code that is valid now; empty if there is none.
std::optional<Pairing> read_pairing(const std::filesystem::path& file);

}  // namespace handcast::control
