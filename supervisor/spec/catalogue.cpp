// SPDX-License-Identifier: Apache-2.0
#include "supervisor/spec/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/settings/files.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/daemon/back_end_files.hpp"

namespace handcast::supervisor {
namespace {

Result<daemon::ServiceDescription> read_description(const std::filesystem::path& file) {
  const auto text = config::read_text(file);
  if (!text) return tl::make_unexpected(text.error());
  auto description = daemon::parse_description(*text);
  if (!description) return fail_in(file.string(), description.error());
  if (description->name != file.stem())
    return fail(Errc::bad_data,
                fmt::format("{}: describes the service '{}'", file.string(), description->name));
  return description;
}

std::vector<std::string> names_of(const std::vector<daemon::BackendDescription>& backends) {
  std::vector<std::string> names;
  for (const auto& backend : backends) names.push_back(backend.name);
  return names;
}

std::string row(const daemon::BackendDescription& backend) {
  const auto reads =
      backend.settings.empty() ? "" : fmt::format("`{}`", join(backend.settings, "` `"));
  return fmt::format("| `{}` | {} | {} | {} |\n", backend.name, backend.sentence, reads,
                     backend.exclusive ? "one process at a time" : "");
}

}  // namespace

std::filesystem::path catalogue_folder(const std::filesystem::path& program_folder) {
  return (program_folder / ".." / "share" / "handcast" / "services").lexically_normal();
}

Catalogue read_catalogue(const std::filesystem::path& folder) {
  Catalogue catalogue;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    // "._camera.json" is what macOS leaves beside a file on a disk of another kind.
    if (entry.path().extension() != ".json" || entry.path().filename().string().starts_with('.'))
      continue;
    auto description = read_description(entry.path());
    if (description)
      catalogue.emplace(description->name, std::move(*description));
    else
      log::warning("{}", description.error().what);
  }
  if (catalogue.empty())
    log::warning("{} has no descriptions of services: any change of the rig restarts all of them",
                 folder.string());
  return catalogue;
}

Result<void> check_backend(const Catalogue& catalogue, const std::string& service,
                           const std::string& backend) {
  const auto found = catalogue.find(service);
  if (found == catalogue.end()) return {};
  const auto& backends = found->second.backends;
  if (backends.empty()) return fail(Errc::bad_config, service + " has no back ends to choose from");
  if (std::ranges::find(backends, backend, &daemon::BackendDescription::name) != backends.end())
    return {};
  if (daemon::back_end_files(service).contains(backend)) return {};
  return fail(Errc::bad_config,
              fmt::format("{} has no back end {}; it has: {}; lib/handcast has no file of this "
                          "name",
                          service, quote(backend), join(names_of(backends), ", ")));
}

bool is_exclusive(const Catalogue& catalogue, const std::string& service,
                  const std::string& backend) {
  const auto found = catalogue.find(service);
  if (found == catalogue.end()) return true;
  const auto& backends = found->second.backends;
  if (backends.empty()) return false;
  const auto row = std::ranges::find(backends, backend, &daemon::BackendDescription::name);
  return row == backends.end() || row->exclusive;
}

std::string print_backends(const Catalogue& catalogue) {
  std::string page =
      "\n# Back ends\n\n"
      "The words that `camera.backend`, `pose.backend`, `landmarks.backend`, "
      "`projector.backend` and `dlp.backend` accept.\n"
      "[docs/writing-a-back-end.md](../docs/writing-a-back-end.md) says how to add one.\n";
  for (const auto& [name, service] : catalogue) {
    if (service.backends.empty()) continue;
    if (const auto first = config::name_at_first(name); !first.empty()) {
      page += fmt::format("\n## {}\n\n{}\nThe back ends of {}, which read the settings of [{}].\n",
                          name, service.summary, first, name);
      continue;
    }
    page += fmt::format("\n## {}\n\n{}\n\n| back end | | reads | |\n|---|---|---|---|\n", name,
                        service.summary);
    for (const auto& backend : service.backends) page += row(backend);
  }
  return page;
}

}  // namespace handcast::supervisor
