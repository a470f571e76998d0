// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

/// Quantities for a person to read: three digits and a unit.
namespace handcast::supervisor {

std::string text_of_span(
    std::int64_t span_ns);  ///< "850 ns", "1.25 ms", "12.3 s", "2 min 5 s", "3 h 12 min", "4 d 2 h"
std::string text_of_bytes(std::int64_t bytes);   ///< "512 B", "38 MiB", "1.5 GiB"
std::string text_of_rate(double per_second);     ///< "240 Hz", "0.5 Hz", "1.2 kHz"
std::string text_of_share(double share);         ///< of one core: "3.1 %", "117 %"
std::string text_of_count(std::uint64_t count);  ///< "12 345 678"

/// Characters a text takes on the screen: those of UTF-8, each of one column.
std::size_t columns_of(std::string_view text);
/// The text's first `columns` characters; where something was cut off, the last of them is an
/// ellipsis.
std::string cut_to(std::string_view text, std::size_t columns);
/// Without what would move the cursor or change colours: what a service or a process calls itself
/// is not to be trusted.
std::string harmless(std::string_view text);

}  // namespace handcast::supervisor
