// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

#include "ipc/base/program.hpp"
#include "services/camera/v4l2/format.hpp"
#include "services/camera/v4l2/list.hpp"
#include "services/tools/devices/ask.hpp"
#include "services/tools/devices/attached.hpp"

namespace handcast::devices {

namespace {

/// The list, or what keeps handcast-camera from giving it: a vendor's library may print or die.
std::vector<Attached> list_of(const std::optional<Answer>& answer) {
  std::string trouble = "it cannot be started";
  if (answer) {
    auto list = daemon::attached_from(answer->text);
    if (list && answer->exit_code == 0) return std::move(*list);
    trouble =
        list ? fmt::format("it ended with exit code {}", answer->exit_code) : list.error().what;
  }
  return {{.name = "`handcast-camera --attached`", .trouble = std::move(trouble)}};
}

}  // namespace

std::vector<Attached> cameras_of_files(const Search& search, const std::string& file) {
  std::vector<std::string> words{program_folder() / "handcast-camera", "--attached"};
  if (!search.name.empty()) words.push_back("--named=" + search.name);
  if (!search.opens) words.emplace_back("--untouched");
  auto found = list_of(ask(std::move(words), STDOUT_FILENO));
  const std::pair<std::string, std::string> of_file("camera.backend", file);
  std::erase_if(found, [&](const Attached& camera) {
    if (camera.settings.empty()) return !camera.names.empty();  // nothing could use it
    return !file.empty() && std::ranges::count(camera.settings, of_file) == 0;
  });
  return found;
}

namespace {

std::vector<Mode> modes_of(const std::vector<camera::v4l2::FormatSizes>& formats) {
  std::vector<Mode> modes;
  for (const auto preferred : camera::v4l2::kFormats)
    for (const auto& format : formats) {
      if (format.code != camera::v4l2::code_of(preferred)) continue;
      for (const auto& sizes : format.sizes)
        modes.push_back({.format = format.name,
                         .least_width_px = sizes.least.width_px,
                         .least_height_px = sizes.least.height_px,
                         .width_px = sizes.most.width_px,
                         .height_px = sizes.most.height_px,
                         .rate_hz = sizes.rate_hz});
    }
  return modes;
}

}  // namespace

std::vector<Attached> webcams() {
  std::vector<Attached> attached;
  for (const auto& found : camera::v4l2::list_cameras()) {
    const auto& identity = found.identity;
    attached.push_back(
        {.kind = Kind::camera,
         .name = identity.card.empty() ? identity.path : camera::v4l2::describe(identity),
         .about = camera::v4l2::describe(found.formats),
         .settings = {{"camera.backend", "v4l2"}, {"camera.v4l2.device", identity.path}},
         .trouble = found.trouble,
         .names = identity.card.empty() ? std::vector{identity.path}
                                        : std::vector{identity.card, identity.bus, identity.path},
         .modes = modes_of(found.formats)});
  }
  return attached;
}

}  // namespace handcast::devices
