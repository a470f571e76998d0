// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>
#include <string>

#include "services/content/projegraphy/remote.hpp"

/// What is exchanged with servers, whichever they are.
namespace handcast::projegraphy {

inline constexpr std::size_t kMostPainting = 24 << 20;  ///< bytes of a reply with a picture
inline constexpr const char* kUnwanted = "hand, fingers, text, nude, gore";

/// What a painter is asked for.
std::string prompt_of(const Servers& servers, std::string_view animal);
/// The mask of a silhouette, white on black: the bytes of a PNG file.
Result<std::string> mask_png(const Silhouette& silhouette);
/// The picture in the bytes of a PNG file of at most 2048 px, kPictureSide_px square. Errors:
/// bad_data.
Result<renderer::Texture> picture_in(const std::string& bytes);

std::string without_slash(std::string url);
std::string text_of(const nlohmann::json& what);
/// Waits unless it is time to stop.
void rest(std::chrono::milliseconds time, const std::stop_token& stop);

}  // namespace handcast::projegraphy
