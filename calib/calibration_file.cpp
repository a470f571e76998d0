// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "calib/calibration.hpp"
#include "calib/file_sections.hpp"
#include "calib/plausibility.hpp"
#include "calib/rigid.hpp"
#include "config/settings/document.hpp"
#include "config/settings/frozen_file.hpp"
#include "config/settings/load.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

/// The calibration file: TOML, declared, checked and printed like a rig file (config/settings).
namespace handcast::calib {
namespace {

const config::Value* member_of(const config::Value& value, std::string_view wanted) {
  const auto* table = std::get_if<config::Table>(&value.data);
  if (!table) return nullptr;
  const auto found = std::ranges::find(*table, wanted, &config::Member::name);
  return found == table->end() ? nullptr : &found->value;
}

bool has_second_camera(const config::Value& document) {
  return member_of(document, "camera2") || member_of(document, "camera2_from_camera");
}

bool has(const config::Value& document, std::string_view section, std::string_view name) {
  const auto* inside = member_of(document, section);
  return inside && member_of(*inside, name);
}

/// What every calibration must say, and this one does not: "camera.focal_px, projector.x are". ""
/// if nothing is missing. A rig without a tracker has no camera_from_tracker.
std::string missing_in(const config::Value& document) {
  std::vector<std::string> missing;
  const auto look_for = [&](const char* section, std::initializer_list<const char*> names) {
    for (const auto* name : names)
      if (!has(document, section, name)) missing.push_back(fmt::format("{}.{}", section, name));
  };
  look_for("camera", {"width_px", "height_px", "focal_px", "centre_px"});
  look_for("projector", {"width_px", "height_px", "x", "y", "w"});
  if (has_second_camera(document)) {
    look_for("camera2", {"width_px", "height_px", "focal_px", "centre_px"});
    look_for("camera2_from_camera", {"x", "y", "z"});
  }
  return missing.empty() ? "" : join(missing, ", ") + (missing.size() == 1 ? " is" : " are");
}

Calibration with_id(Calibration calibration) {
  std::uint32_t hash = 2166136261u;  // FNV-1a
  Calibration measured = calibration;
  measured.made = {};
  for (const char c : print_calibration(measured))
    hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  calibration.id = std::max(hash, 1u);
  return calibration;
}

}  // namespace

Result<Calibration> load_calibration(const std::filesystem::path& path) {
  if (path.empty()) return with_id(reference_rig());
  const auto source = config::read_file_or_frozen(path.string());
  if (std::error_code unknown; !source && !std::filesystem::exists(path, unknown))
    return fail(source.error().code,
                source.error().what +
                    "; a relative path of a calibration begins at the folder of the rig file: a "
                    "rig file that is copied needs the calibration copied, or its whole path");
  if (!source) return tl::make_unexpected(source.error());
  const auto& name = source->path;
  const auto document = config::parse_document(source->text, name);
  if (!document) return tl::make_unexpected(document.error());

  const bool has_second = has_second_camera(*document);
  auto file = to_pair_file(reference_rig());
  config::Faults faults;
  config::apply_document(
      *document, name,
      has_second ? config::list_settings(file) : config::list_settings(static_cast<File&>(file)),
      faults);
  if (const auto missing = missing_in(*document); !missing.empty())
    faults.add(fmt::format("{}: {} missing; a part of a calibration fits no rig", name, missing));
  auto calibration =
      with_id(has_second ? to_calibration(file) : to_calibration(static_cast<File&>(file)));
  if (faults.empty()) check_plausible(calibration, name, faults);
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  calibration.camera_from_tracker = orthonormalised(calibration.camera_from_tracker);
  if (calibration.camera2)
    calibration.camera2->from_camera = orthonormalised(calibration.camera2->from_camera);
  return calibration;
}

Result<void> check_device(std::string_view what, std::string_view calibrated,
                          std::initializer_list<std::string_view> names) {
  if (calibrated.empty() || std::ranges::find(names, calibrated) != names.end()) return {};
  return fail(Errc::bad_config,
              fmt::format("the calibration was made with the {0} {1}, and this is {2}; name the "
                          "calibration of this {0} in the rig file (calibration), or calibrate it",
                          what, quote(calibrated), quote(*names.begin())));
}

std::string print_calibration(const Calibration& calibration) {
  constexpr auto kTitle = "The calibration of a rig.";
  auto file = to_pair_file(calibration);
  return calibration.camera2
             ? config::print_settings(config::list_settings(file), kTitle)
             : config::print_settings(config::list_settings(static_cast<File&>(file)), kTitle);
}

}  // namespace handcast::calib
