// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "calib/sub_frames.hpp"
#include "config/sections/sub_frames.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

Result<std::unique_ptr<Projector>> open_twin(const config::Rig&, const calib::Calibration&);
Result<std::unique_ptr<Projector>> open_file(const config::Rig&, const calib::Calibration&);
Result<std::unique_ptr<Projector>> open_window(const config::Rig&, const calib::Calibration&);
Result<std::unique_ptr<Projector>> open_kms(const config::Rig&, const calib::Calibration&);

static constexpr std::array kBackends{
    ProjectorBackend{.name = "twin",
                     .sentence = "Models a projector: takes frames at its rate, shows none.",
                     .open = open_twin},
    ProjectorBackend{.name = "file",
                     .sentence = "Writes the light to a folder: as PNG pictures, of which it keeps "
                                 "100, or as a film.",
                     .open = open_file},
#ifdef HANDCAST_WITH_WINDOW
    ProjectorBackend{.name = "window",
                     .sentence = "Shows the light on a monitor or projector of an X server, in a "
                                 "window or full screen.",
                     .open = open_window},
#endif
#ifdef HANDCAST_WITH_KMS
    ProjectorBackend{.name = "kms",
                     .sentence = "Shows the light on a monitor or projector without a window "
                                 "system; the kernel tells when it came.",
                     .open = open_kms,
                     .exclusive = true},
#endif
};

std::span<const ProjectorBackend> projector_backends() { return kBackends; }

Result<std::unique_ptr<Projector>> open_projector(const config::Rig& rig,
                                                  const calib::Calibration& calibration) {
  config::Rig of_output = rig;
  of_output.projector = config::output_of(rig.projector);
  return service::open_backend("projector", rig.projector.backend, projector_backends(), of_output,
                               calib::output_of(calibration, rig.projector.packing));
}

}  // namespace handcast::projector
