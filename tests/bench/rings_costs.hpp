// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "ipc/ring/reader.hpp"

/// What a ring's verbs cost on one core, everything in its caches. Medians, in ns.
namespace handcast::bench {

/// Loan and publish together, with this many readers attached. `busy`: one of them, on the other
/// core, takes and gives back without end.
double loan_and_publish_ns(int readers, bool busy = false);

/// To take the newest message of `bytes`, and give it back.
double take_ns(std::size_t bytes, ipc::Hold hold);

}  // namespace handcast::bench
