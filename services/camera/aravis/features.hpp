// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/camera/aravis/glib.hpp"

namespace handcast::camera::aravis {

/// Sets a GenICam feature by name, from text of the form that its kind asks for: a number, a word,
/// true or false; a command takes none. `assignment`: "BlackLevel=4" or "TimestampReset". Errors:
/// bad_config (there is no such feature, or it refuses the value; the sentence gives its range or
/// words), unavailable.
Result<void> set_feature(ArvCamera* camera, const std::string& assignment);

/// The words of a feature that is a choice, "Off, On"; empty if it is none.
std::string words_of_feature(ArvCamera* camera, const char* name);

}  // namespace handcast::camera::aravis
