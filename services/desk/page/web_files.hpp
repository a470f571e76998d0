// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

/// The files of web/, embedded by the build.
namespace handcast::desk {

/// The page, its style, and its scripts.
/// @{
extern const std::string_view kIndexHtml, kPageCss;
extern const std::string_view kPageJs, kDomJs, kControlsJs, kRigJs, kPictureJs, kChartJs, kToolsJs;
/// @}

}  // namespace handcast::desk
