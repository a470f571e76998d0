#pragma once
#include <filesystem>
#include <string>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// Writes the rig as it is applied, settings and all, to RIG.toml in the runtime folder: what services read when they are started
/// again. The person's own file may be half edited at that moment; it counts when it is reloaded. Errors: unavailable.
Result<std::filesystem::path> write_applied(const config::Rig& rig);
void forget_applied(const std::string& rig);

}  // namespace handcast::supervisor
