// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "services/desk/osc/packet.hpp"

namespace handcast::test {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

inline desk::osc::Bytes bytes_of(std::string_view packet) {
  return {reinterpret_cast<const std::uint8_t*>(packet.data()), packet.size()};
}

/// A message: packet("/a/b", 0.5f, "x").
template <class... Arguments>
std::string packet(std::string_view address, Arguments... arguments) {
  desk::osc::MessageWriter writer(address);
  (writer.add(arguments), ...);
  return writer.packet();
}

/// A bundle for a time.
inline std::string bundle_at(std::uint64_t time_tag, std::span<const std::string> packets) {
  auto bundle = desk::osc::write_bundle(packets);
  for (int i = 0; i < 8; ++i) bundle[8 + i] = static_cast<char>(time_tag >> (56 - 8 * i) & 0xff);
  return bundle;
}

}  // namespace handcast::test
