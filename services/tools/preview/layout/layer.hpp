// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bitset>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::preview {

/// What can be shown over one another in the camera panel, from the lowest to the uppermost.
enum class Layer { image, regions, light, drawing, joints, landmarks };
/// Number of layers.
inline constexpr std::size_t kLayers = 6;
/// The names of the layers, in the order of Layer.
inline constexpr std::array<std::string_view, kLayers> kLayerNames{
    "image", "regions", "light", "drawing", "joints", "landmarks"};

/// The layers that are shown, by the number of the layer.
using Layers = std::bitset<kLayers>;

/// True if this layer is shown.
inline bool shows(const Layers& layers, Layer layer) {
  return layers[static_cast<std::size_t>(layer)];
}

/// The layers that are shown by default: the image and the light on it, which the others hide.
Layers default_layers();
/// The layers of a text like "image,joints"; "all" is all of them. Errors: bad_config.
Result<Layers> parse_layers(std::string_view text);

}  // namespace handcast::preview
