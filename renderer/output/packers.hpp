// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/output/packing.hpp"

/// The packers, each in a file of its own.
namespace handcast::renderer {

std::unique_ptr<Packer> make_grey_plane_packer(const config::Projector& settings, int width_px,
                                               int height_px);
std::unique_ptr<Packer> make_colour_plane_packer(const config::Projector& settings, int width_px,
                                                 int height_px);
std::unique_ptr<Packer> make_quadrant_packer(const config::Projector& settings, int width_px,
                                             int height_px);

}  // namespace handcast::renderer
