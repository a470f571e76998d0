// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/live_settings.hpp"

/// Live settings as values: what msg::LiveSettings carries, and how it changes.
namespace handcast::config {

/// The rig with these values (msg::LiveSettings::values) over those of its file. Errors:
/// bad_config.
Result<Rig> with_live(const Rig& filed, std::string_view values);

/// The values after a change, all or none: of assignments "path=value", as in --set; "path" alone
/// is the value of the file again. Values that are those of the file are left out. Errors:
/// bad_config (one line for each fault: no such setting, one that is not live, a bad value).
Result<std::string> changed_values(const Rig& filed, std::string_view values,
                                   std::span<const std::string> assignments);
/// The values that all live settings of a file have which are not those of `filed`. `toml`: a
/// preset. Errors: bad_config.
Result<std::string> values_of_preset(const Rig& filed, const std::string& toml,
                                     std::string_view file);

/// Puts new values into the message, and the old ones into its `undo`. Changes of
/// the same settings by one source within a second are one. `what`: "path = value, path = value".
/// Errors: bad_config (they are too many for a message).
Result<void> change(msg::LiveSettings& settings, std::string_view values, std::string_view what,
                    std::string_view source, std::int64_t now_ns);
/// Takes the last change back, or does it again. Errors: bad_config (there is none).
/// @{
Result<void> undo(msg::LiveSettings& settings, std::string_view source);
Result<void> redo(msg::LiveSettings& settings, std::string_view source);
/// @}

}  // namespace handcast::config
