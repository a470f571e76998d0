// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/watch/day.hpp"

namespace handcast::watch {

/// The report of a day, as `handcast day` prints it.
std::string report_text(const Day& day);
/// The same as one HTML file, which needs no other and no network.
std::string report_page(const Day& day);

/// A length of time as people say it: "7 h 05 min", "12 s".
std::string span_text(double seconds);

}  // namespace handcast::watch
