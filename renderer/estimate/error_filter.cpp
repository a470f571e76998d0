// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/error_filter.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

constexpr auto kErrors = static_cast<Eigen::Index>(error::kCount);
constexpr Eigen::Index kNumbers = 2 * kLandmarks;  ///< of a detection
constexpr double kNotSeen_px = 1e4;

constexpr double square(double x) { return x * x; }
constexpr Eigen::Index index(std::size_t error) { return static_cast<Eigen::Index>(error); }

/// Of each bend, without what those of a finger share.
const ErrorPrior kBendPrior{error::kBend, kFingers* kBendsOfFinger,
                            std::hypot(kSharedBend_rad, kOwnBend_rad), kPosture_s};

/// Errors as a vector of Eigen.
auto as_vector(HandErrors& errors) { return Eigen::Map<Eigen::VectorXd>(errors.data(), kErrors); }

/// How much of the displacement of its row a landmark has. None on a folded finger: there, bends
/// displace joints in the same way.
double share_of_row(const ArticulatedHand& hand, int landmark) {
  const int finger = finger_of_landmark(landmark);
  return finger > 0 ? 1 - folded(hand.flexions()[finger]) : 0;
}

}  // namespace

ErrorFilter::ErrorFilter()
    : covariance_(kErrors, kErrors),
      noise_(kNumbers),
      residual_(kNumbers),
      expected_(kNumbers, kNumbers),
      slopes_(kErrors, kNumbers),
      spread_(kErrors, kNumbers),
      whitened_(kNumbers, kErrors),
      root_(kNumbers) {
  begin();
}

void ErrorFilter::begin() {
  errors_.fill(0);
  usual_sigma_m_ = 0;
  covariance_.setZero();
  sigma_px_.fill(kUnknownSigma_px);
  for_priors(usual_sigma_m_, [this](const ErrorPrior& prior) { set_variance(prior); });
  for (int finger = 0; finger < kFingers; ++finger) add_bends(finger, 1);
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    set_variance(seen_prior(landmark, sigma_px_[landmark], seen_s_));
}

HandErrors ErrorFilter::kept_after(double seconds) const {
  HandErrors kept;
  kept.fill(1);
  const auto fade = [&](const ErrorPrior& prior, double gross_s = kGross_s) {
    const double usual = prior.kept(seconds),
                 gross = std::exp(-seconds / std::max(prior.lasts_s, gross_s));
    for (std::size_t i = prior.first; i < prior.first + static_cast<std::size_t>(prior.count); ++i)
      kept[i] = std::abs(errors_[i]) > kHuber * prior.sd ? gross : usual;
  };
  for_priors(usual_sigma_m_, [&](const ErrorPrior& prior) { fade(prior); });
  fade(kBendPrior);
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    fade(seen_prior(landmark, sigma_px_[landmark], seen_s_), kLasting_s);
  return kept;
}

void ErrorFilter::set_variance(const ErrorPrior& prior) {
  covariance_.diagonal().segment(index(prior.first), prior.count).setConstant(square(prior.sd));
}

/// Adds a share of the prior covariance of a finger's bends.
void ErrorFilter::add_bends(int finger, double share) {
  const auto first = index(error::bend_of(finger, 0));
  auto block = covariance_.block<kBendsOfFinger, kBendsOfFinger>(first, first);
  block.array() += share * square(kSharedBend_rad);
  block.diagonal().array() += share * square(kOwnBend_rad);
}

void ErrorFilter::pass(double seconds, const Flexions& flexions, float rest) {
  seen_s_ = kSeen_s / (1 - kSeenAtRest * rest);
  auto kept = kept_after(seconds);
  const auto share = as_vector(kept).array();
  as_vector(errors_).array() *= share;
  covariance_.array().colwise() *= share;
  covariance_.array().rowwise() *= share.transpose();

  const auto add = [&](const ErrorPrior& prior) {
    covariance_.diagonal().segment(index(prior.first), prior.count).array() += prior.added(seconds);
  };
  for_priors(usual_sigma_m_, add);
  const double renewed = 1 - std::exp(-2 * seconds / kPosture_s);
  for (int finger = 0; finger < kFingers; ++finger)
    add_bends(finger, renewed * square(1 + (kFoldedBend - 1) * folded(flexions[finger])));
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    add(seen_prior(landmark, sigma_px_[landmark], seen_s_));
}

void ErrorFilter::unbend(const Flexions& snapped_rad) {
  for (int finger = 0; finger < kFingers; ++finger)
    for (int b = 0; b < kBendsOfFinger; ++b) {
      const auto bend = error::bend_of(finger, b);
      errors_[bend] -= snapped_rad[finger][b];
      covariance_.diagonal()[index(bend)] += square(kUnbent * snapped_rad[finger][b]);
    }
}

void ErrorFilter::forget_place() {
  constexpr auto kForgotten = index(error::kPlace);
  std::fill_n(errors_.begin(), kForgotten, 0);
  covariance_.topRows(kForgotten).setZero();
  covariance_.leftCols(kForgotten).setZero();
  for_priors(usual_sigma_m_, [&](const ErrorPrior& prior) {
    if (index(prior.first) < kForgotten) set_variance(prior);
  });
  set_variance({error::kShift, 3, kJump_m, kLasting_s});
  for (int finger = 0; finger < kFingers; ++finger) add_bends(finger, 1);
}

void ErrorFilter::set_noise(const msg::HandLandmarks& seen) {
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto& point = seen.points[landmark];
    sigma_px_[landmark] = point.sigma_px > 0 ? point.sigma_px : kUnknownSigma_px;
    const double noise_px = std::hypot(kWhiteShare * sigma_px_[landmark], kLeastNoise_px);
    noise_.segment<2>(2 * landmark).setConstant(square(was_seen(point) ? noise_px : kNotSeen_px));
  }
}

/// Learns how wrong the detector usually says that its landmarks are.
void ErrorFilter::learn_sigma(const calib::CameraModel& camera, const HandJoints& reported) {
  constexpr double kNews = 1e-3;  // of an image
  double sum_px = 0;
  for (const double sigma_px : sigma_px_) sum_px += sigma_px;
  const double sigma_m = sum_px / kLandmarks * reported.at_m[joint_of_landmark(0)].z / camera.fx_px;
  if (usual_sigma_m_ > 0) {
    usual_sigma_m_ += kNews * (sigma_m - usual_sigma_m_);
    return;
  }
  usual_sigma_m_ = sigma_m;
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    set_variance(place_prior(landmark, sigma_m));
}

/// Without the places of joints that are the detector's errors.
HandErrors ErrorFilter::of_tracker(HandErrors errors) const {
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const double share = own_share(landmark, usual_sigma_m_);
    for (std::size_t axis = 0; axis < 3; ++axis) errors[error::place_of(landmark) + axis] *= share;
  }
  return errors;
}

/// Sets how far the landmarks are from where the errors put them, and the derivatives.
void ErrorFilter::linearise(const calib::CameraModel& camera, const HandJoints& reported,
                            const msg::HandLandmarks& seen) {
  const auto own = of_tracker(errors_);
  const ArticulatedHand hand(reported, own);
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto joint = joint_of_landmark(landmark);
    const auto place = error::place_of(landmark);
    glm::dvec3 beside = vector_at(errors_, place) - vector_at(own, place);
    if (const double share = share_of_row(hand, landmark); share > 0) {
      const auto row = error::row_of(landmark);
      beside += share * glm::dvec3(0, errors_[row], errors_[row + 1]);
    }
    const glm::dvec3 at_m = hand.joints().at_m[joint] + hand.joints().axes[joint] * beside;
    add_slopes(landmark, camera.jacobian_px_per_m(hand.rigid_m(joint)), hand);
    const auto error = error::seen_of(landmark);
    const auto at_px = camera.project(at_m) + glm::dvec2(errors_[error], errors_[error + 1]);
    const auto off_px = was_seen(seen.points[landmark])
                            ? glm::dvec2(position_px(seen.points[landmark])) - at_px
                            : glm::dvec2(0);
    residual_.segment<2>(2 * landmark) << off_px.x, off_px.y;
  }
}

/// Sets the derivatives of a landmark, and the covariance times them. Most are 0.
void ErrorFilter::add_slopes(int landmark, const glm::dmat3x2& px_per_m,
                             const ArticulatedHand& hand) {
  auto slope = slopes_.middleCols<2>(2 * landmark), product = spread_.middleCols<2>(2 * landmark);
  slope.setZero();
  product.setZero();
  const auto add = [&](std::size_t error, const glm::dvec2& px) {
    for (int axis = 0; axis < 2; ++axis) {
      slope(index(error), axis) += px[axis];
      product.col(axis) += px[axis] * covariance_.col(index(error));
    }
  };
  const auto add_vector = [&](std::size_t first, const glm::dmat3& way) {
    const glm::dmat3x2 px = px_per_m * way;
    for (int i = 0; i < 3; ++i) add(first + static_cast<std::size_t>(i), px[i]);
  };
  const auto add_number = [&](std::size_t error, const glm::dvec3& way) {
    add(error, px_per_m * way);
  };
  hand.derivatives(landmark, add_vector, add_number);
  if (const double share = share_of_row(hand, landmark); share > 0) {
    const glm::dmat3 axes = share * hand.joints().axes[joint_of_landmark(landmark)];
    add_number(error::row_of(landmark), axes[1]);
    add_number(error::row_of(landmark) + 1, axes[2]);
  }
  add(error::seen_of(landmark), {1, 0});
  add(error::seen_of(landmark) + 1, {0, 1});
}

void ErrorFilter::expect(const calib::CameraModel& camera, const HandJoints& reported,
                         const msg::HandLandmarks& seen) {
  linearise(camera, reported, seen);
  expected_.noalias() = slopes_.transpose() * spread_;
  expected_.diagonal() += noise_;
}

/// How far off a landmark is, in standard deviations.
double ErrorFilter::deviation(int landmark) const {
  const int at = 2 * landmark;
  const double likely = expected_(at, at) + expected_(at + 1, at + 1);
  return std::sqrt(2 * residual_.segment<2>(at).squaredNorm() / likely);
}

/// False for a landmark outside of the image, say.
bool ErrorFilter::is_seen(int landmark) const { return noise_(2 * landmark) < square(kNotSeen_px); }

bool ErrorFilter::is_contradicted() const {
  std::array<double, kLandmarks> off;
  auto end = off.begin();
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    if (is_seen(landmark)) *end++ = deviation(landmark);
  const auto middle = off.begin() + (end - off.begin()) / 2;
  std::nth_element(off.begin(), middle, end);
  return end != off.begin() && *middle > kContradicted;
}

/// A finger that the tracker has moved abruptly, and that is far from three of its landmarks or
/// more, may be anywhere now: fewer may be outliers. Returns whether there is one.
bool ErrorFilter::free_fingers(const AbruptLandmarks& abrupt) {
  std::array<int, kFingers> far{};
  for (int landmark = first_landmark(0); landmark < kLandmarks; ++landmark)
    if (abrupt[landmark] == Abrupt::tracker && deviation(landmark) > kHuber)
      ++far[finger_of_landmark(landmark)];
  bool any = false;
  for (int finger = 0; finger < kFingers; ++finger) {
    if (far[finger] < 3) continue;
    any = true;
    add_bends(finger, square(kFreedBend_rad / kSharedBend_rad));
    covariance_.diagonal()[index(error::spread_of(finger))] += square(kFreedSpread_rad);
    covariance_.diagonal()
        .segment<2 * kLandmarksOfFinger>(index(error::drift_of(first_landmark(finger))))
        .array() += square(kFreed_m);
  }
  return any;
}

/// A landmark whose error was gross, and that the detector has moved abruptly, is right again:
/// forgets its error, and that it was moved. Returns whether there is one.
bool ErrorFilter::end_errors(AbruptLandmarks& abrupt) {
  bool any = false;
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto seen = index(error::seen_of(landmark));
    const auto errors_px = as_vector(errors_).segment<2>(seen);
    if (abrupt[landmark] != Abrupt::detector || deviation(landmark) < kHuber ||
        errors_px.norm() < kHuber * sigma_px_[landmark])
      continue;
    any = true;
    end_error(seen_prior(landmark, sigma_px_[landmark], seen_s_));
    abrupt[landmark] = Abrupt::neither;
  }
  return any;
}

/// A fault that was explained in turn by a joint's drift and by the detector leaves two gross
/// errors that cancel, and that nothing tells apart. Forgets both. Returns whether there is one.
bool ErrorFilter::end_opposite_errors() {
  bool any = false;
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto drift = index(error::drift_of(landmark)), seen = index(error::seen_of(landmark));
    const auto errors = as_vector(errors_);
    const Eigen::Vector2d seen_px = errors.segment<2>(seen);
    const Eigen::Vector2d drift_px =
        slopes_.block<2, 2>(drift, 2 * landmark).transpose() * errors.segment<2>(drift);
    const double least_px = std::min(seen_px.norm(), drift_px.norm());
    if (least_px < kHuber * sigma_px_[landmark] || (seen_px + drift_px).norm() > least_px) continue;
    any = true;
    end_error(seen_prior(landmark, sigma_px_[landmark], seen_s_));
    end_error({error::drift_of(landmark), 2, kDrift_m, kDrift_s});
  }
  return any;
}

/// Sets an error to 0, as likely as at first.
void ErrorFilter::end_error(const ErrorPrior& prior) {
  const auto first = index(prior.first);
  as_vector(errors_).segment(first, prior.count).setZero();
  covariance_.middleRows(first, prior.count).setZero();
  covariance_.middleCols(first, prior.count).setZero();
  set_variance(prior);
}

/// Landmarks that are further off than is likely count less: those that the detector has moved
/// abruptly may have a new error that lasts, the others that of one image.
void ErrorFilter::doubt_landmarks(const AbruptLandmarks& abrupt) {
  double variances = 0;
  int numbers = 0;
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    if (is_seen(landmark)) {
      variances += expected_.diagonal().segment<2>(2 * landmark).sum();
      numbers += 2;
    }
  const double mean_variance = variances / std::max(numbers, 1);
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const double off = deviation(landmark);
    if (!(off > kHuber)) continue;
    const int at = 2 * landmark;
    if (abrupt[landmark] == Abrupt::detector) {
      const auto seen = index(error::seen_of(landmark));
      const double more = residual_.segment<2>(at).squaredNorm();
      for (int axis = 0; axis < 2; ++axis) {
        covariance_(seen + axis, seen + axis) += more;
        spread_(seen + axis, at + axis) += more;
        expected_(at + axis, at + axis) += more;
      }
    } else {
      const double more = mean_variance * (square(off / kHuber) - 1);
      noise_.segment<2>(at).array() += more;
      expected_.diagonal().segment<2>(at).array() += more;
    }
  }
}

bool ErrorFilter::update(const calib::CameraModel& camera, const HandJoints& reported,
                         const msg::HandLandmarks& seen, AbruptLandmarks abrupt) {
  set_noise(seen);
  learn_sigma(camera, reported);
  expect(camera, reported, seen);
  if (is_contradicted()) return false;
  const bool is_freed = free_fingers(abrupt), is_ended = end_errors(abrupt),
             is_opposite = end_opposite_errors();
  if (is_freed || is_ended || is_opposite) expect(camera, reported, seen);
  doubt_landmarks(abrupt);
  root_.compute(expected_);
  root_.solveInPlace(residual_);
  auto state = as_vector(errors_);
  state.noalias() += spread_ * residual_;
  reduce_covariance();
  if (!state.allFinite() || !covariance_.diagonal().allFinite()) begin();
  return true;
}

/// By what the landmarks have told.
void ErrorFilter::reduce_covariance() {
  whitened_ = spread_.transpose();
  root_.matrixL().solveInPlace(whitened_);
  covariance_.selfadjointView<Eigen::Lower>().rankUpdate(whitened_.transpose(), -1);
  covariance_.triangularView<Eigen::StrictlyUpper>() = covariance_.transpose();
}

double ErrorFilter::surprise() const {
  double sum = 0;
  const auto add = [&](const ErrorPrior& prior) {
    for (std::size_t i = prior.first; i < prior.first + static_cast<std::size_t>(prior.count); ++i)
      sum += square(errors_[i] / prior.sd);
  };
  for_priors(usual_sigma_m_, add);
  add(kBendPrior);
  for (int landmark = 0; landmark < kLandmarks; ++landmark)
    add(seen_prior(landmark, sigma_px_[landmark], seen_s_));
  return sum;
}

HandErrors ErrorFilter::errors_after(double seconds) const {
  auto errors = kept_after(seconds);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] *= errors_[i];
  return of_tracker(errors);
}

}  // namespace handcast::renderer
