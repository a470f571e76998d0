// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/tools/try/trial.hpp"

namespace handcast::trial {

/// draw_source().
using Draw = std::function<Report(const Wanted&, const std::function<void(const Report&)>& tell)>;

/// `draw` in a process of its own, which is ended if `wanted.patience_s` pass without a
/// step. The caller has one thread, and no OpenGL. A crash or a hang is in the report.
Report draw_apart(const Wanted& wanted, const Draw& draw = draw_source);

}  // namespace handcast::trial
