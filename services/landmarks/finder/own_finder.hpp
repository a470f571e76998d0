// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>

#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::landmarks::own {

/// Hands by our own network, which comes with handcast. No palm network does: where `models` holds
/// MediaPipe's, it says where a hand without a tracker may be. `most_hands`: 1 or 2. Errors:
/// bad_config.
Result<HandFinder> open_finder(const std::filesystem::path& models, int most_hands);

}  // namespace handcast::landmarks::own
