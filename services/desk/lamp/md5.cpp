// SPDX-License-Identifier: Apache-2.0
#include "services/desk/lamp/md5.hpp"

#include <fmt/format.h>
#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include <array>
#include <cstdint>

namespace handcast::desk::lamp {

std::string md5(std::string_view text) {
  std::array<std::uint8_t, 16> digest{};
  gnutls_hash_fast(GNUTLS_DIG_MD5, text.data(), text.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace handcast::desk::lamp
