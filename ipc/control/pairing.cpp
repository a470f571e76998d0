// SPDX-License-Identifier: Apache-2.0
#include "ipc/control/pairing.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"

namespace handcast::control {
namespace {

constexpr std::uint64_t kCodes = 100'000'000;

}  // namespace

Pairing new_pairing(Role role) {
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != static_cast<ssize_t>(sizeof number)) std::abort();
  return {fmt::format("{:08}", number % kCodes), role, now_ns() + kPairingLasts_ns};
}

std::filesystem::path pairing_file(std::filesystem::path desk_file) {
  return desk_file.replace_extension(".pair");
}

Result<void> write_pairing(const std::filesystem::path& file, const Pairing& pairing) {
  const nlohmann::json json{{"code", pairing.code},
                            {"role", kRoleNames[static_cast<std::size_t>(pairing.role)]},
                            {"until_ns", pairing.until_ns}};
  return write_private(file, json.dump() + "\n");
}

std::optional<Pairing> read_pairing(const std::filesystem::path& file) {
  const auto text = read_input(file, kMostText);
  const auto json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
  if (!json.is_object()) return std::nullopt;
  const auto code = json.find("code"), role = json.find("role"), until = json.find("until_ns");
  if (code == json.end() || role == json.end() || until == json.end() || !code->is_string() ||
      !role->is_string() || !until->is_number_integer())
    return std::nullopt;
  const auto found = std::ranges::find(kRoleNames, role->get<std::string>());
  const auto left_ns = until->get<std::int64_t>() - now_ns();
  // More than it may be: of a time before this computer was started again.
  if (found == kRoleNames.end() || left_ns <= 0 || left_ns > kPairingLasts_ns) return std::nullopt;
  return Pairing{*code, static_cast<Role>(found - kRoleNames.begin()), *until};
}

}  // namespace handcast::control
