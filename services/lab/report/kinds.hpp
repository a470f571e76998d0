// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace handcast::report {

/// The first value of a file of results that is not of the kind that the report needs, as
/// "/coverage must be a number"; empty if there is none. Values that are missing or null were not
/// measured. The members of "bins" and "services" are not checked.
std::string wrong_kind(const nlohmann::json& results);

/// Parses JSON that is nested at most 32 deep. Returns a discarded value if the text is none.
nlohmann::json parse_shallow(const std::string& text);

}  // namespace handcast::report
