// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::study {

/// Where subjects marked that they looked, from the marks in the folders among `files`: the
/// conditions side by side, from dark (nobody) over red to white (everybody). Empty if there are no
/// marks. Marks of another size than the first ones are left out.
std::optional<renderer::Texture> heat_map(const std::vector<std::string>& files);

}  // namespace handcast::study
