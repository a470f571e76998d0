// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "services/projector/dlp/dlp_controller.hpp"
#include "services/projector/dlp/sequence/sequence.hpp"

namespace handcast::dlp {

Result<std::unique_ptr<DlpController>> open_lightcrafter(const config::Rig& rig);

static constexpr std::array kBackends{
    DlpBackend{.name = "lightcrafter",
               .sentence = "TI DLPC350 (LightCrafter 4500) or DLPC900 (6500, 9000) by USB.",
               .open = open_lightcrafter,
               .reads = {"dlp", "projector.packing", "projector.rate_hz"},
               .exclusive = true},
};

std::span<const DlpBackend> dlp_backends() { return kBackends; }

Result<std::unique_ptr<DlpController>> open_dlp(const config::Rig& rig) {
  return service::open_backend("dlp", rig.dlp.backend, dlp_backends(), rig);
}

Result<void> check_dlp(const config::Rig& rig) {
  if (auto known = service::check_backend("dlp", rig.dlp.backend, dlp_backends(), rig); !known)
    return known;
  if (rig.dlp.mode == config::DlpMode::video) return {};
  // The DLPC900 permits the shorter patterns.
  const auto sequence =
      make_sequence(protocol::Controller::dlpc900, rig.projector, protocol::kGreen);
  return sequence ? Result<void>() : tl::make_unexpected(sequence.error());
}

}  // namespace handcast::dlp
