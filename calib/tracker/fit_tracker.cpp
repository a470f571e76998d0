// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/fit_tracker.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "calib/tracker/findings.hpp"
#include "calib/tracker/first_pose.hpp"
#include "calib/tracker/pose_refiner.hpp"

namespace handcast::calib {
namespace {

constexpr std::size_t kLeastSightings = 40;
constexpr double kFits_sigmas = 3;
constexpr double kLeastSigma_px = 0.2;
constexpr double kTukeyLimit = 4.685;
/// What is known of the offset before: without motion it cannot be measured, and then its interval
/// is that of this standard deviation.
constexpr double kPriorOffset_s = 0.1;

/// Student's t for 95 %, two-sided (approximation of Cornish & Fisher, within 1 % from 3 degrees of
/// freedom on).
double students_t(double freedom) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom) +
         (3 * z5 * z * z + 19 * z5 + 17 * z3 - 15 * z) / (384 * freedom * freedom * freedom);
}

std::vector<Sighting> usable(std::span<const Sighting> sightings) {
  std::vector<Sighting> good;
  for (const auto& one : sightings)
    if (std::isfinite(one.undistorted_px.x) && std::isfinite(one.undistorted_px.y) &&
        one.sigma_px > 0 && std::isfinite(one.sigma_px))
      good.push_back(one);
  std::ranges::stable_sort(good, {}, &Sighting::time_ns);
  return good;
}

bool overlap(std::span<const Sighting> seen, const TrackerPath& path) {
  return std::ranges::any_of(
      seen, [&](const Sighting& one) { return path.at(one.time_ns, one.point).has_value(); });
}

/// The fit and what it is judged by.
class Fit {
 public:
  Fit(std::vector<Sighting> seen, const TrackerPath& path, const CameraModel& camera,
      const PoseAndOffset& start)
      : seen_(std::move(seen)), path_(path), camera_(camera), pose_(start) {}

  TrackerFit run() {
    refine_and_judge();
    leave_out_beginning();
    judge_blocks();
    TrackerFit fit;
    fit.camera_from_tracker = pose_.camera_from_tracker;
    fit.clock_offset_ns = std::llround(pose_.offset_s * 1e9);
    fit.inlier_share = inlier_share();
    fit.residual_px = median_error_of_fitting();
    fit.held_out_px = held_out_px_;
    fit.middle_m = glm::dvec3(glm::inverse(pose_.camera_from_tracker) * glm::dvec4(centre_m_, 1));
    describe_spread(fit);
    fit.quality = quality_of(fit);
    describe(fit);
    return fit;
  }

 private:
  void refine_and_judge() {
    centre_m_ = mean_place();
    pose_ = refine(seen_, path_, camera_, pose_, centre_m_);
    judge();
    centre_m_ = mean_place();
  }

  glm::dvec3 mean_place() const {
    glm::dvec3 sum(0);
    double count = 0;
    for (const auto& one : seen_)
      if (const auto at = path_.at(one.time_ns, one.point)) {
        sum += glm::dvec3(pose_.camera_from_tracker * glm::dvec4(at->place_m, 1));
        ++count;
      }
    return count > 0 ? sum / count : sum;
  }

  void judge() {
    judged_.clear();
    std::vector<double> errors;
    for (const auto& one : seen_)
      if (const auto found = difference(one, path_, camera_, pose_, centre_m_)) {
        const auto at = path_.at(one.time_ns + offset_ns(), one.point);
        const glm::dvec3 place(pose_.camera_from_tracker * glm::dvec4(at->place_m, 1));
        judged_.push_back({one, place, glm::length(found->error_px), false});
        errors.push_back(judged_.back().error_px);
      }
    sigma_px_ = std::max(kLeastSigma_px, robust_sigma_px(std::move(errors)));
    for (auto& one : judged_) one.fits = one.error_px < kFits_sigmas * sigma_px_;
  }
  std::int64_t offset_ns() const { return static_cast<std::int64_t>(pose_.offset_s * 1e9); }

  void leave_out_beginning() {
    if (judged_.empty()) return;
    const auto begin_ns = begin_of_fit_ns(judged_);
    left_out_s_ = 1e-9 * static_cast<double>(begin_ns - judged_.front().seen.time_ns);
    if (left_out_s_ <= 0) return;
    std::erase_if(seen_, [&](const Sighting& one) { return one.time_ns < begin_ns; });
    refine_and_judge();
  }

  double inlier_share() const {
    if (judged_.empty()) return 0;
    return static_cast<double>(std::ranges::count_if(judged_, &Judged::fits)) /
           static_cast<double>(judged_.size());
  }

  double median_error_of_fitting() const {
    std::vector<double> errors;
    for (const auto& one : judged_)
      if (one.fits) errors.push_back(one.error_px);
    return robust_sigma_px(std::move(errors)) * std::sqrt(2 * std::log(2.0));
  }

  /// The normal equations of each block of time.
  std::vector<NormalEquations> equations_of_blocks() const {
    const double span_s =
        1e-9 * static_cast<double>(judged_.back().seen.time_ns - judged_.front().seen.time_ns);
    const auto count = static_cast<std::size_t>(std::clamp(std::floor(span_s), 4.0, 40.0));
    const double length_ns = std::max(1.0, span_s * 1e9 / static_cast<double>(count));
    std::vector<NormalEquations> blocks(count);
    for (const auto& one : judged_) {
      const auto block = static_cast<std::size_t>(
          static_cast<double>(one.seen.time_ns - judged_.front().seen.time_ns) / length_ns);
      const auto found = difference(one.seen, path_, camera_, pose_, centre_m_);
      const double weight = tukey(one.error_px, kTukeyLimit * sigma_px_);
      if (found && weight > 0) blocks[std::min(block, count - 1)].add(*found, weight);
    }
    std::erase_if(blocks, [](const NormalEquations& block) { return block.matrix.isZero(); });
    return blocks;
  }

  /// The jackknife: the covariance of the parameters, and the errors of blocks that were left out.
  void judge_blocks() {
    if (judged_.empty()) return;
    const auto blocks = equations_of_blocks();
    NormalEquations all;
    for (const auto& block : blocks) all += block;
    all.matrix(6, 6) += std::pow(sigma_px_ / kPriorOffset_s, 2);
    is_determined_ = is_regular(all.matrix);
    if (!is_determined_ || blocks.size() < 2) {
      is_determined_ = false;
      return;
    }
    const double n = static_cast<double>(blocks.size());
    Eigen::Matrix<double, 7, Eigen::Dynamic> steps(7, static_cast<Eigen::Index>(blocks.size()));
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      NormalEquations rest = all;
      rest.matrix -= blocks[b].matrix;
      rest.right -= blocks[b].right;
      steps.col(static_cast<Eigen::Index>(b)) = rest.step();
    }
    const Eigen::Matrix<double, 7, Eigen::Dynamic> off = steps.colwise() - steps.rowwise().mean();
    covariance_ = (n - 1) / n * (off * off.transpose());
    const Matrix7 of_noise = sigma_px_ * sigma_px_ * all.matrix.inverse();
    for (int i = 0; i < 7; ++i)  // never better than independent errors would make it
      if (covariance_(i, i) < of_noise(i, i)) covariance_(i, i) = of_noise(i, i);
    factor_ = students_t(std::max(1.0, n - 1));
    held_out_px_ = median_held_out(steps);
  }

  static bool is_regular(const Matrix7& matrix) {
    constexpr double kLeast = 1e-7;
    const Vector7 scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Matrix7 scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<Matrix7>(scaled).eigenvalues()[0] > kLeast;
  }

  /// Median error of what fits, of each block by the fit without it.
  double median_held_out(const Eigen::Matrix<double, 7, Eigen::Dynamic>& steps) const {
    std::vector<double> errors;
    const auto blocks = static_cast<std::size_t>(steps.cols());
    const double begin_ns = static_cast<double>(judged_.front().seen.time_ns),
                 span_ns = static_cast<double>(judged_.back().seen.time_ns) - begin_ns + 1;
    for (const auto& one : judged_) {
      if (!one.fits) continue;
      const auto block = static_cast<Eigen::Index>(
          (static_cast<double>(one.seen.time_ns) - begin_ns) / span_ns *
          static_cast<double>(blocks));
      const auto without = stepped(pose_, steps.col(block), centre_m_);
      if (const auto found = difference(one.seen, path_, camera_, without, centre_m_))
        errors.push_back(glm::length(found->error_px));
    }
    return robust_sigma_px(std::move(errors)) * std::sqrt(2 * std::log(2.0));
  }

  /// Half the width of the 95 % interval of the light at a place, across the camera's axis, mm.
  double light_error_mm(const glm::dvec3& place_m) const {
    if (!is_determined_) return std::numeric_limits<double>::infinity();
    const glm::dvec3 arm = place_m - centre_m_;
    Eigen::Matrix<double, 3, 6> moves;
    moves << 0, arm.z, -arm.y, 1, 0, 0, -arm.z, 0, arm.x, 0, 1, 0, arm.y, -arm.x, 0, 0, 0, 1;
    Eigen::Matrix<double, 2, 3> across;
    across << 1, 0, -place_m.x / place_m.z, 0, 1, -place_m.y / place_m.z;
    const Eigen::Matrix<double, 2, 6> slope = across * moves;
    const Eigen::Matrix2d spread =
        slope * covariance_.topLeftCorner<6, 6>() * slope.transpose();
    return 1e3 * factor_ *
           std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()[1]);
  }

  void describe_spread(TrackerFit& fit) const {
    const auto half = [&](int i) {
      return is_determined_ ? factor_ * std::sqrt(covariance_(i, i))
                            : std::numeric_limits<double>::infinity();
    };
    constexpr double kDegrees = 180 / std::numbers::pi;
    for (int i = 0; i < 3; ++i) {
      fit.spread.turn_deg[i] = kDegrees * half(i);
      fit.spread.place_mm[i] = 1e3 * half(3 + i);
    }
    fit.spread.offset_ms = 1e3 * half(6);
    fit.middle_error_mm = light_error_mm(centre_m_);
    const auto covered = covered_by(judged_, camera_);
    for (const double x : {0.0, 1.0})
      for (const double y : {0.0, 1.0})
        for (const double z : {covered.nearest_m, covered.farthest_m}) {
          const glm::dvec3 ray((x * camera_.width_px - camera_.cx_px) / camera_.fx_px,
                               (y * camera_.height_px - camera_.cy_px) / camera_.fy_px, 1);
          fit.corner_error_mm = std::max(fit.corner_error_mm, light_error_mm(z * ray));
        }
  }

  static Quality quality_of(const TrackerFit& fit) {
    if (fit.middle_error_mm <= 2 && fit.inlier_share >= 0.7) return Quality::good;
    return fit.middle_error_mm <= 5 && fit.inlier_share >= 0.5 ? Quality::usable : Quality::poor;
  }

  void describe(TrackerFit& fit) const {
    auto& findings = fit.findings;
    const auto covered = covered_by(judged_, camera_);
    constexpr int kEnoughCells = 7;
    constexpr double kEnoughDepth_m = 0.12;
    if (covered.image_cells < kEnoughCells || covered.farthest_m - covered.nearest_m < kEnoughDepth_m)
      findings.push_back(fmt::format(
          "the points cover {} of 9 parts of the image and {:.0f} cm of depth: the tracker's place "
          "is uncertain by {:.1f} mm along the camera's axis; move through the whole image, and "
          "nearer and farther",
          covered.image_cells, 100 * (covered.farthest_m - covered.nearest_m),
          fit.spread.place_mm.z));
    if (fit.inlier_share < 0.7)
      findings.push_back(
          fmt::format("only {:.0f} % of the points fit, to {:.1f} px: do tracker and camera see "
                      "the same hand, and is the lens right?",
                      100 * fit.inlier_share, kFits_sigmas * sigma_px_));
    if (left_out_s_ > 0)
      findings.push_back(
          fmt::format("the first {:.1f} s do not fit, and were left out", left_out_s_));
    std::ranges::move(exchanged_fingers(judged_, path_, camera_, pose_, sigma_px_),
                      std::back_inserter(findings));
    if (std::abs(pose_.offset_s) > kLongestOffset_s)
      findings.push_back(
          fmt::format("the clocks differ by {:.0f} ms, which is more than was looked for: are the "
                      "time stamps right?",
                      1e3 * pose_.offset_s));
    else if (fit.spread.offset_ms > 10)
      findings.push_back("the clocks cannot be compared, because the hand hardly moved");
  }

  std::vector<Sighting> seen_;
  const TrackerPath& path_;
  const CameraModel& camera_;
  PoseAndOffset pose_;
  glm::dvec3 centre_m_{0};  ///< of the points, in camera space
  std::vector<Judged> judged_;
  double sigma_px_ = 1, held_out_px_ = 0, left_out_s_ = 0;
  Matrix7 covariance_ = Matrix7::Zero();
  double factor_ = 2;
  bool is_determined_ = false;
};

}  // namespace

Result<TrackerFit> fit_tracker(std::span<const TrackerSample> samples,
                               std::span<const Sighting> sightings, const CameraModel& camera) {
  auto seen = usable(sightings);
  if (seen.size() < kLeastSightings)
    return fail(Errc::bad_data, fmt::format("{} points in the images are too few: {} are needed. "
                                            "Hold the hand so that tracker and camera see it",
                                            seen.size(), kLeastSightings));
  const TrackerPath path(samples);
  if (path.empty()) return fail(Errc::bad_data, "the tracker has seen no hand");
  if (!overlap(seen, path))
    return fail(Errc::bad_data, "there is no time at which both camera and tracker saw the hand: "
                                "are the time stamps of the two on the same clock?");
  const auto start = first_pose(seen, path, camera);
  if (!start)
    return fail(Errc::bad_data, "no place of the tracker explains what the camera saw: do both see "
                                "the same hand, and does it move?");
  return Fit(std::move(seen), path, camera, *start).run();
}

}  // namespace handcast::calib
