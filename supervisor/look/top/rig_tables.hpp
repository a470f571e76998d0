// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "supervisor/look/top/top_model.hpp"
#include "supervisor/look/top/top_table.hpp"

namespace handcast::supervisor {

/// The services, a row each; what is wrong with one stands below its row.
Table service_table(const TopModel& model);

/// The rings, each with its readers below it. `with_marks`: also the rings of stage marks.
Table ring_table(const TopModel& model, bool with_marks);

}  // namespace handcast::supervisor
