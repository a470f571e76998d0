// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

/// How people reach the page of a rig's desk. The desk keeps the address and the tokens in a file
/// that only this user can read; `handcast desk` reads it. The tokens stay the same when the desk
/// is started again, so that an open page goes on.
namespace handcast::control {

/// What a person may do at the page. Each may do what those before may.
enum class Role : std::uint8_t {
  viewer,     ///< look on
  operator_,  /// change live settings, show content, work the cues
  owner,      ///< save, restart and swap services
};
inline constexpr std::size_t kRoles = 3;  ///< number of roles
/// Their names, by Role.
inline constexpr std::array<std::string_view, kRoles> kRoleNames{"viewer", "operator", "owner"};

/// Where other computers reach the page, encrypted.
struct LanAddress {
  std::string address;  ///< "192.168.1.5", or "0.0.0.0": each address of this computer
  std::uint16_t port = 0;
  std::string fingerprint;  ///< the first bytes of the SHA-256 of the certificate, "AB:CD:…"
  std::string fault;        ///< why it cannot be reached; empty: it can
};

/// The address of the page, and what tells who may do what there.
struct DeskAddress {
  std::string url;                         ///< "http://127.0.0.1:8480"
  std::array<std::string, kRoles> tokens;  ///< by Role; 64 hexadecimal digits each
  std::optional<LanAddress> lan{};         ///< empty: no other computer reaches it

  /// The address with the token behind a #, which a browser keeps to itself.
  std::string url_for(Role role) const {
    return url + "/#token=" + tokens[static_cast<std::size_t>(role)];
  }
};

/// Fresh tokens from the kernel's random numbers.
std::array<std::string, kRoles> new_tokens();

/// The file of a rig: where it is, or, if there is none, where it would be. It is in the runtime
/// folder of the rig's unit (/run/handcast/RIG), in handcast/ in the user's folder for what lives
/// as long as the computer is up ($XDG_RUNTIME_DIR, /run/user/ID), or in /tmp/handcast-ID/. Errors:
/// bad_config (not a name of a rig), unavailable (such a folder cannot be made, or others may write
/// to it).
Result<std::filesystem::path> desk_file(std::string_view rig);
/// Errors: unavailable (there is none), bad_data (it is damaged).
Result<DeskAddress> read_desk_file(const std::filesystem::path& file);
/// Errors: unavailable.
Result<void> write_desk_file(const std::filesystem::path& file, const DeskAddress& address);

/// Writes a file that only this user can read. Errors: unavailable.
Result<void> write_private(const std::filesystem::path& file, std::string_view text);
/// The addresses (IPv4) by which other computers may reach this one.
std::vector<std::string> own_addresses();

}  // namespace handcast::control
