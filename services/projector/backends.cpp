// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "services/projector/projector.hpp"

namespace handcast::projector {

Result<std::unique_ptr<Projector>> open_twin(const config::Rig&);
Result<std::unique_ptr<Projector>> open_file(const config::Rig&);

static constexpr std::array kBackends{
    ProjectorBackend{.name = "twin",
                     .sentence = "Models a projector: takes frames at its rate, shows none.",
                     .open = open_twin},
    ProjectorBackend{.name = "file",
                     .sentence = "Writes every 100th frame as a PNG picture to light/ in the "
                                 "folder of `up --out`, or in the "
                                 "current folder; keeps 100 of them.",
                     .open = open_file},
};

std::span<const ProjectorBackend> projector_backends() { return kBackends; }

Result<std::unique_ptr<Projector>> open_projector(const config::Rig& rig) {
  return service::open_backend("projector", rig.projector.backend, projector_backends(), rig);
}

}  // namespace handcast::projector
