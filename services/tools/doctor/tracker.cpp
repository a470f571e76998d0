// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/tracker.hpp"

#include <fmt/format.h>

#include <optional>
#include <variant>

#include "config/settings/settings.hpp"
#include "services/pose/openxr/manifest.hpp"
#include "services/tools/devices/trackers.hpp"
#ifdef HANDCAST_WITH_OPENXR
#include "services/pose/openxr/probe.hpp"
#endif

namespace handcast::doctor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSoftware = "tracker software";

/// The text of a setting; empty if it is empty or this build does not have it.
std::string text_of(config::Rig rig, std::string_view path) {
  const auto listing = config::list_settings(rig);
  const auto* setting = config::find_setting(listing, path);
  const auto* text = setting ? std::get_if<std::string*>(&setting->target) : nullptr;
  return text ? **text : "";
}

Finding leapc_software(const config::Rig& rig, const fs::path& root) {
  const auto chosen = text_of(rig, "pose.leapc.library");
  std::error_code unknown;
  if (!chosen.empty() && !fs::exists(chosen, unknown))
    return {kSoftware, Grade::fault, fmt::format("'{}' is missing", chosen),
            "correct pose.leapc.library"};
  const auto found = chosen.empty() ? devices::leapc_library(root) : std::optional(chosen);
  if (found) return {kSoftware, Grade::good, "Ultraleap's library, " + *found, ""};
  return {kSoftware, Grade::fault, "Ultraleap's library is missing", devices::leapc_remedy()};
}

Finding leapc_device(const fs::path& root) {
  const auto attached = devices::usb_trackers(root);
  if (!attached.empty())
    return {"tracker device", Grade::good,
            fmt::format("{} at USB {}", attached.front().name, attached.front().port), ""};
  return {"tracker device", Grade::fault, "no device of Ultraleap is on the USB",
          "plug it in; `lsusb` lists what the kernel sees"};
}

std::vector<Finding> openxr(const config::Rig& rig, [[maybe_unused]] Asking asking) {
  const auto& settings = rig.pose.openxr;
  const auto runtime = pose::openxr::find_runtime(settings.runtime);
  if (!runtime)
    return {{kSoftware, Grade::fault, runtime.error().what,
             "install a runtime with hand tracking, e.g. Monado, and start its service"}};
  std::vector<Finding> findings{
      {kSoftware, Grade::good, fmt::format("OpenXR runtime '{}', {}", runtime->name, runtime->file),
       ""}};
#ifdef HANDCAST_WITH_OPENXR
  if (asking == Asking::not_now) return findings;
  const auto answer = pose::openxr::probe(settings);
  findings.push_back(answer ? Finding{"tracker service", Grade::good, *answer + " answers", ""}
                            : Finding{"tracker service", Grade::fault, answer.error().what,
                                      "docs/operating/trackers.md, \"OpenXR\""});
#else
  findings.push_back({"tracker service", Grade::fault, "this build cannot use OpenXR",
                      "install libopenxr-dev, and build again"});
#endif
  return findings;
}

}  // namespace

std::vector<Finding> examine_tracker(const config::Rig& rig, Asking asking, const fs::path& root) {
  std::vector<Finding> findings;
  for (const auto& backend : {rig.pose.backend, rig.pose.second}) {
    if (backend == "leapc")
      findings.insert(findings.end(), {leapc_software(rig, root), leapc_device(root)});
    if (backend == "openxr")
      for (auto& finding : openxr(rig, asking)) findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace handcast::doctor
