// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>

#include "services/tools/try/trial.hpp"

namespace handcast::trial {

/// What a report says, on one line without its end: "Life.fs: moves, 3.1 ms a picture (99 %: 3.4)".
std::string verdict(const Report& report);
/// Its parameters, one a line.
std::string parameter_list(const Report& report);
/// How many did what: tried, loaded, drawn, moves, reacts, still, plain, hangs, crashes.
Report count(std::span<const Report> reports);
/// The same as a sentence.
std::string summary(std::span<const Report> reports);

}  // namespace handcast::trial
