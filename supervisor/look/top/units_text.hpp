// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

/// Formats quantities for people, with three digits and a unit.
namespace handcast::supervisor {

/// A duration: "850 ns", "1.25 ms", "12.3 s", "2 min 5 s", "3 h 12 min", "4 d 2 h".
std::string text_of_span(std::int64_t span_ns);
/// A size: "512 B", "38 MiB", "1.5 GiB".
std::string text_of_bytes(std::int64_t bytes);
/// A rate: "240 Hz", "0.5 Hz", "1.2 kHz".
std::string text_of_rate(double per_second);
/// A share in percent, which may exceed 100 %: "3.1 %", "117 %".
std::string text_of_share(double share);
/// A number with separated thousands: "12 345 678".
std::string text_of_count(std::uint64_t count);

/// The width of a UTF-8 text on the screen, with one column for each character.
std::size_t columns_of(std::string_view text);
/// The first `columns` characters of a text. If it is cut off, the last one is an ellipsis.
std::string cut_to(std::string_view text, std::size_t columns);
/// Replaces control characters by '?'. Names of services and processes may contain sequences that
/// move the cursor or change colours.
std::string harmless(std::string_view text);

}  // namespace handcast::supervisor
