// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/daemon/description.hpp"

namespace handcast::supervisor {

/// The services that are installed, by name, as their programs describe themselves.
using Catalogue = std::map<std::string, daemon::ServiceDescription, std::less<>>;

/// Where the descriptions are if the programs are in `program_folder`:
/// ../share/handcast/services/NAME.json
std::filesystem::path catalogue_folder(const std::filesystem::path& program_folder);

/// Reads the descriptions in a folder. A file that is not one is logged and left out; a service
/// without a description counts as one that reads every setting.
Catalogue read_catalogue(const std::filesystem::path& folder);

/// Checks that a service has a back end. A service without a description, and the file of a back
/// end, pass: only the service's program can tell. Errors: bad_config (the sentence lists the back
/// ends that it has).
Result<void> check_backend(const Catalogue& catalogue, const std::string& service,
                           const std::string& backend);

/// True if only one process at a time can have the back end of a service open. A service or back
/// end that is not in the catalogue counts as exclusive.
bool is_exclusive(const Catalogue& catalogue, const std::string& service,
                  const std::string& backend);

/// The back ends of each service as a page of Markdown, for config/REFERENCE.md.
std::string print_backends(const Catalogue& catalogue);

}  // namespace handcast::supervisor
