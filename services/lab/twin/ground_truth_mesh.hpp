// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::twin {

/// The surface of a true hand, before a person's bones and widths are put on it.
struct GroundTruthMesh {
  renderer::HandMesh mesh;     ///< of the wanted side
  bool is_drawn_mesh = false;  ///< it is the mesh that the cascade draws
};

/// The model that `twin.shape.mesh` names: "handcast" (`drawn` itself), "webxr", "implicit"
/// (implicit_hand()), or a glTF file of a left hand, which is mirrored for the right. Without the
/// files of "webxr" it is `drawn`.
/// Errors: those of renderer::load_hand(), bad_config (no joints at the finger tips,
/// a right hand).
Result<GroundTruthMesh> load_ground_truth_mesh(const std::string& mesh,
                                               const renderer::HandMesh& drawn);

/// The file of the left WebXR hand that `scripts/setup --hands` installs; empty if there is none.
/// HANDCAST_WEBXR_HAND names another one.
std::filesystem::path webxr_hand_file();

}  // namespace handcast::twin
