// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/calibration.hpp"
#include "calib/rigid.hpp"
#include "config/settings/document.hpp"
#include "config/settings/frozen_file.hpp"
#include "config/settings/load.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/join.hpp"

/// The calibration file: TOML, declared, checked and printed like a rig file (config/settings).
namespace handcast::calib {

using config::between;
using config::Range;

/// The largest width and height of an image, and its largest area: buffers of up to 46 bytes per
/// pixel of the projector (measured at 8192 x 8192) stay below a gigabyte.
constexpr int kMostPixels = 8192;
constexpr double kMostArea_px2 = 16e6;

struct CameraSection {
  std::string device;
  int width_px, height_px;
  std::vector<double> focal_px, centre_px, distortion;
};

template <class Visitor>
void describe(Visitor& visitor, CameraSection& camera) {
  visitor.field("device", camera.device,
                "The camera that was calibrated: its serial number, or its name or bus, as "
                "`handcast devices` lists it. With any other one, the rig does not start. Empty: "
                "not known.");
  visitor.field("width_px", camera.width_px, between(16, kMostPixels, "px"), "Width of the image.");
  visitor.field("height_px", camera.height_px, between(16, kMostPixels, "px"),
                "Height of the image.");
  visitor.field("focal_px", camera.focal_px, between(1, 1e6, "px"), "Focal lengths fx, fy.");
  visitor.field("centre_px", camera.centre_px, between(-1e5, 1e5, "px"),
                "Principal point cx, cy; (0, 0) is the centre of the top-left pixel.");
  visitor.field("distortion", camera.distortion, between(-1e3, 1e3),
                "Brown-Conrady coefficients k1, k2, p1, p2, k3.");
}

struct TransformSection {
  std::vector<double> x, y, z;
};

template <class Visitor>
void describe(Visitor& visitor, TransformSection& rows) {
  visitor.field("x", rows.x, between(-1e5, 1e5),
                "Camera x (right) of the tracker's three axes and of its origin.");
  visitor.field("y", rows.y, between(-1e5, 1e5), "Camera y (down) of these.");
  visitor.field("z", rows.z, between(-1e5, 1e5), "Camera z (forward) of these.");
}

struct ProjectorSection {
  std::string device;
  int width_px, height_px;
  std::vector<double> x, y, w;
  double plane_m;
  std::vector<double> parallax;
};

template <class Visitor>
void describe(Visitor& visitor, ProjectorSection& projector) {
  visitor.field("device", projector.device,
                "The projector that was calibrated: the name of the monitor, as `handcast devices` "
                "lists it. With any other one, the rig does not start. Empty: not known.");
  visitor.field("width_px", projector.width_px, between(16, kMostPixels, "px"),
                "Width of the image.");
  visitor.field("height_px", projector.height_px, between(16, kMostPixels, "px"),
                "Height of the image.");
  visitor.field("x", projector.x, Range{},
                "First row of the homography from undistorted camera pixels to projector pixels.");
  visitor.field("y", projector.y, Range{}, "Second row.");
  visitor.field("w", projector.w, Range{}, "Third row: the divisor of both.");
  visitor.field("plane_m", projector.plane_m, between(0.05, 100, "m"),
                "Distance from the camera, along its axis, at which the homography holds.");
  visitor.field(
      "parallax", projector.parallax, between(-1e6, 1e6),
      "Change of the homography's last column for each 1/m that a point is nearer. Zeros: "
      "camera and projector are coaxial, and the homography holds everywhere.");
}

template <class Visitor>
void describe(Visitor& visitor, Made& made) {
  visitor.field("lens", made.lens, "The camera's lens.");
  visitor.field("screen", made.screen, "The projector.");
  visitor.field("tracker", made.tracker, "The tracker's place.");
  visitor.field("lens2", made.lens2, "The second camera's lens.");
  visitor.field("pair", made.pair, "The second camera's place.");
}

struct File {
  CameraSection camera;
  TransformSection camera_from_tracker;
  ProjectorSection projector;
  Made made;
};

template <class Visitor>
void describe(Visitor& visitor, File& file) {
  visitor.section("camera", file.camera, "The infrared camera.");
  visitor.section("camera_from_tracker", file.camera_from_tracker,
                  "Rigid transform, in rows; the last column is in metres.");
  visitor.section("projector", file.projector, "The projector.");
  visitor.section("made", file.made,
                  "When and how well the parts were measured; written by `handcast calibrate`.");
}

/// The file of a rig with a second camera.
struct PairFile : File {
  CameraSection camera2;
  TransformSection camera2_from_camera;
};

template <class Visitor>
void describe(Visitor& visitor, PairFile& file) {
  describe(visitor, static_cast<File&>(file));
  visitor.section("camera2", file.camera2, "The second infrared camera, for hands from two views.");
  visitor.section("camera2_from_camera", file.camera2_from_camera,
                  "Rigid transform from the first camera, in rows as camera_from_tracker.");
}

namespace {

constexpr double kRigidTolerance = 1e-3;
constexpr double kFarthestTracker_m = 10;

template <class Matrix>
std::vector<double> row_of(const Matrix& matrix, int row) {
  std::vector<double> values(Matrix::length());
  for (int column = 0; column < Matrix::length(); ++column) values[column] = matrix[column][row];
  return values;
}

template <class Matrix>
void set_row(Matrix& matrix, int row, const std::vector<double>& values) {
  for (int column = 0; column < Matrix::length(); ++column) matrix[column][row] = values[column];
}

CameraSection to_section(const std::string& device, const CameraModel& c) {
  return {device,
          c.width_px,
          c.height_px,
          {c.fx_px, c.fy_px},
          {c.cx_px, c.cy_px},
          {c.k1, c.k2, c.p1, c.p2, c.k3}};
}

TransformSection to_section(const glm::dmat4& transform) {
  return {row_of(transform, 0), row_of(transform, 1), row_of(transform, 2)};
}

File to_file(const Calibration& calibration) {
  const auto& tracker = calibration.camera_from_tracker;
  const auto& homography = calibration.projector_from_camera;
  const auto& e = calibration.parallax;
  return {to_section(calibration.camera_device, calibration.camera),
          to_section(tracker),
          {calibration.projector_device,
           calibration.projector_width_px,
           calibration.projector_height_px,
           row_of(homography, 0),
           row_of(homography, 1),
           row_of(homography, 2),
           calibration.plane_m,
           {e.x, e.y, e.z}},
          calibration.made};
}

/// `calibration` may lack a second camera: the first one stands for it.
PairFile to_pair_file(const Calibration& calibration) {
  const auto& first = calibration.camera;
  const auto second = calibration.camera2.value_or(SecondCamera{{}, first, glm::dmat4(1)});
  return {to_file(calibration), to_section(second.device, second.camera),
          to_section(second.from_camera)};
}

CameraModel to_camera_model(const CameraSection& s) {
  return {s.width_px,      s.height_px,     s.focal_px[0],   s.focal_px[1],
          s.centre_px[0],  s.centre_px[1],  s.distortion[0], s.distortion[1],
          s.distortion[2], s.distortion[3], s.distortion[4]};
}

glm::dmat4 to_transform(const TransformSection& rows) {
  glm::dmat4 transform(1);
  set_row(transform, 0, rows.x);
  set_row(transform, 1, rows.y);
  set_row(transform, 2, rows.z);
  return transform;
}

Calibration to_calibration(const File& file) {
  Calibration calibration;
  calibration.camera_device = file.camera.device;
  calibration.projector_device = file.projector.device;
  calibration.camera = to_camera_model(file.camera);
  calibration.camera_from_tracker = to_transform(file.camera_from_tracker);
  const auto& projector = file.projector;
  calibration.projector_width_px = projector.width_px;
  calibration.projector_height_px = projector.height_px;
  set_row(calibration.projector_from_camera, 0, projector.x);
  set_row(calibration.projector_from_camera, 1, projector.y);
  set_row(calibration.projector_from_camera, 2, projector.w);
  calibration.parallax = {projector.parallax[0], projector.parallax[1], projector.parallax[2]};
  calibration.plane_m = projector.plane_m;
  calibration.made = file.made;
  return calibration;
}

Calibration to_calibration(const PairFile& file) {
  Calibration calibration = to_calibration(static_cast<const File&>(file));
  calibration.camera2 = SecondCamera{file.camera2.device, to_camera_model(file.camera2),
                                     to_transform(file.camera2_from_camera)};
  return calibration;
}

/// Where the pixels of the projector lie in the undistorted camera image, on a grid. Empty if one
/// of them lies nowhere, that is on or behind the horizon of the homography.
std::vector<glm::dvec2> screen_in_camera(const Calibration& calibration) {
  constexpr int kSteps = 16;
  const glm::dmat3 camera_from_projector = glm::inverse(calibration.projector_from_camera);
  const glm::dvec2 last(calibration.projector_width_px - 1, calibration.projector_height_px - 1);
  std::vector<glm::dvec2> grid;
  double side = 0;  // of the horizon, at the first point
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const auto at =
          camera_from_projector * glm::dvec3(last * glm::dvec2(j, i) / double{kSteps}, 1);
      if (grid.empty()) side = at.z;
      const glm::dvec2 px = glm::dvec2(at) / at.z;
      if (!(at.z * side > 0) || !std::isfinite(px.x) || !std::isfinite(px.y)) return {};
      grid.push_back(px);
    }
  return grid;
}

/// Why no coaxial rig can have this homography. Empty if one can.
std::string fault_of_homography(const Calibration& calibration) {
  constexpr double kLeastShare = 0.01;
  const auto grid = screen_in_camera(calibration);
  if (grid.empty()) return "the horizon of the homography crosses the projector's image";
  const glm::dvec2 size(calibration.camera.width_px, calibration.camera.height_px);
  int inside = 0;
  for (const glm::dvec2& px : grid) {
    const glm::dvec2 place = px / size;  // 0..1 in the image
    if (!(glm::all(glm::greaterThan(place, glm::dvec2(-1.5))) &&
          glm::all(glm::lessThan(place, glm::dvec2(2.5)))))
      return fmt::format(
          "the homography puts projector pixels far outside the camera image, e.g. "
          "at ({:.4g}, {:.4g})",
          px.x, px.y);
    inside += glm::all(glm::greaterThan(place, glm::dvec2(0))) &&
              glm::all(glm::lessThan(place, glm::dvec2(1)));
  }
  if (inside < kLeastShare * static_cast<double>(grid.size()))
    return "the homography puts the projector's image beside the camera image";
  const auto [low_x, high_x] = std::minmax_element(
      grid.begin(), grid.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [low_y, high_y] = std::minmax_element(
      grid.begin(), grid.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  if ((high_x->x - low_x->x) * (high_y->y - low_y->y) < kLeastShare * size.x * size.y)
    return "the homography shrinks the projector's image to a spot";
  return {};
}

void check_size(std::string_view what, double width_px, double height_px, std::string_view file,
                config::Faults& faults) {
  if (width_px * height_px > kMostArea_px2)
    faults.add(fmt::format("{}: {}: {} x {} px are too many; at most {} megapixels are possible",
                           file, what, width_px, height_px, kMostArea_px2 / 1e6));
}

/// A focal length in pixels of rows or columns against the image's size in that direction: sensors
/// that put rows together have two focal lengths.
void check_focal(std::string_view what, double focal_px, int size_px, std::string_view size,
                 std::string_view file, config::Faults& faults) {
  constexpr double kShortest = 0.15, kLongest = 20;
  if (focal_px < kShortest * size_px || focal_px > kLongest * size_px)
    faults.add(
        fmt::format("{}: {}.focal_px: {} px is not plausible for an image of {} px; it "
                    "must be {} to {} {} of the image",
                    file, what, focal_px, size_px, kShortest, kLongest, size));
}

/// Lenses between a fisheye and a telescope, whose axis meets the image or passes close by.
void check_lens(std::string_view what, const CameraModel& camera, std::string_view file,
                config::Faults& faults) {
  check_focal(what, camera.fx_px, camera.width_px, "widths", file, faults);
  check_focal(what, camera.fy_px, camera.height_px, "heights", file, faults);
  const glm::dvec2 centre(camera.cx_px / camera.width_px, camera.cy_px / camera.height_px);
  if (glm::any(glm::greaterThan(glm::abs(centre - 0.5), glm::dvec2(1.5))))
    faults.add(
        fmt::format("{}: {}.centre_px: the principal point lies more than an image "
                    "beside the image",
                    file, what));
}

/// `what`: "camera_from_tracker"; `whose`: "tracker".
void check_transform(std::string_view what, std::string_view whose, const glm::dmat4& transform,
                     std::string_view file, config::Faults& faults) {
  if (const double off = distance_from_rigid(transform); !(off < kRigidTolerance))
    faults.add(
        fmt::format("{}: {}: its first three columns are not a right-handed "
                    "rotation (off by {:.2g}; {} is allowed)",
                    file, what, off, kRigidTolerance));
  if (const double away_m = glm::length(glm::dvec3(transform[3])); !(away_m < kFarthestTracker_m))
    faults.add(
        fmt::format("{}: {}: the {} is {:.3g} m away from the camera; "
                    "at most {} m are possible. Is it in millimetres?",
                    file, what, whose, away_m, kFarthestTracker_m));
}

void check_camera(std::string_view what, const CameraModel& camera, std::string_view file,
                  config::Faults& faults) {
  check_size(what, camera.width_px, camera.height_px, file, faults);
  check_lens(what, camera, file, faults);
  if (faults.empty() && camera.folds())
    faults.add(
        fmt::format("{}: {}.distortion: the lens folds the image: near its edge, two "
                    "directions map to one pixel",
                    file, what));
}

/// Two cameras at one place see no depth.
void check_pair(const Calibration& calibration, std::string_view file, config::Faults& faults) {
  constexpr double kLeastApart_m = 0.005;
  const auto& second = *calibration.camera2;
  check_transform("camera2_from_camera", "second camera", second.from_camera, file, faults);
  check_camera("camera2", second.camera, file, faults);
  if (glm::length(glm::dvec3(second.from_camera[3])) < kLeastApart_m)
    faults.add(
        fmt::format("{}: camera2_from_camera: the cameras are less than {} mm apart, and see no "
                    "depth. Is it in metres?",
                    file, 1e3 * kLeastApart_m));
}

void check(const Calibration& calibration, std::string_view file, config::Faults& faults) {
  check_transform("camera_from_tracker", "tracker", calibration.camera_from_tracker, file, faults);
  check_size("projector", calibration.projector_width_px, calibration.projector_height_px, file,
             faults);
  check_camera("camera", calibration.camera, file, faults);
  if (calibration.camera2) check_pair(calibration, file, faults);
  if (!(std::abs(glm::determinant(calibration.projector_from_camera)) > 1e-9))
    faults.add(fmt::format(
        "{}: projector: the rows x, y, w of the homography are linearly dependent", file));
  else if (const auto fault = fault_of_homography(calibration); !fault.empty())
    faults.add(fmt::format("{}: projector: {}", file, fault));
}

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
  if (faults.empty()) check(calibration, name, faults);
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  calibration.camera_from_tracker = orthonormalised(calibration.camera_from_tracker);
  if (calibration.camera2)
    calibration.camera2->from_camera = orthonormalised(calibration.camera2->from_camera);
  return calibration;
}

Result<void> check_device(std::string_view what, std::string_view calibrated,
                          std::initializer_list<std::string_view> names) {
  if (calibrated.empty() || std::ranges::find(names, calibrated) != names.end()) return {};
  return fail(
      Errc::bad_config,
      fmt::format("the calibration was made with the {0} '{1}', and this is '{2}'; name the "
                  "calibration of this {0} in the rig file (calibration), or calibrate it",
                  what, calibrated, *names.begin()));
}

std::string print_calibration(const Calibration& calibration) {
  constexpr auto kTitle = "The calibration of a rig.";
  auto file = to_pair_file(calibration);
  return calibration.camera2
             ? config::print_settings(config::list_settings(file), kTitle)
             : config::print_settings(config::list_settings(static_cast<File&>(file)), kTitle);
}

}  // namespace handcast::calib
