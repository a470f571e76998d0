// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "config/settings/document.hpp"
#include "services/desk/base/panel.hpp"

namespace handcast::desk {

/// The value that a TOML text stands for, as in Values::toml. A text that is none: an empty string.
config::Value read_value(std::string_view toml);

/// The number of a value: a toggle is 0 or 1, a choice the place of its word. Empty if it has none.
std::optional<double> number_of(const Control& control, std::string_view toml);

/// "0..1", "at least 0 ms", "one of: hold, velocity"; empty if every value of the kind is allowed.
std::string print_allowed(const Control& control);

/// The shortest text of a number that reads back as the same: "0.5". `is_float`: as a float, so
/// that 0.1f is "0.1".
std::string print_number(double number, bool is_float = false);

/// The assignment "path=value" that sets a control to a number: a toggle is on from 0.5 up, a
/// choice is the word at that place, a whole number must be one. Errors: bad_data (a sentence that
/// begins with the number; the control takes none).
Result<std::string> assign_number(const Control& control, double number, bool is_float = false);
/// The same with a text, for texts and choices.
Result<std::string> assign_text(const Control& control, std::string_view text);

}  // namespace handcast::desk
