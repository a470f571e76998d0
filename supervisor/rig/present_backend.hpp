// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The present name of the back end that `word` names for `service`. Errors (bad_config): an old
/// word that also stands for a second setting, of which the rig has another value. A swap changes
/// only the back end.
Result<std::string> present_backend(const std::string& service, const std::string& word,
                                    config::Rig rig);

}  // namespace handcast::supervisor
