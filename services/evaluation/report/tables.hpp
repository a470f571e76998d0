// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/evaluation/report/inputs.hpp"

namespace handcast::report {

std::string headline(const Inputs& inputs);  ///< the three runs in one figure each
std::string accuracy_table(
    const Inputs& inputs);  ///< METHOD's metrics for the three, each with how to read it
std::string speed_table(
    const Inputs& inputs);  ///< error and coverage per speed of the hand, drawn and in figures
std::string live_table(
    const Inputs& inputs);  ///< rates asked and held, restarts, and the observer's score

}  // namespace handcast::report
