// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "config/sections/openxr.hpp"
#include "ipc/base/result.hpp"

namespace handcast::pose::openxr {

/// Opens a session with the runtime and closes it again, in a process of its own, because a runtime
/// may crash or hang. Returns its name. Call it with one thread. Errors: those of Session::open(),
/// and unavailable (it has crashed, or does not answer for 10 s).
Result<std::string> probe(const config::OpenXr& settings);

}  // namespace handcast::pose::openxr
