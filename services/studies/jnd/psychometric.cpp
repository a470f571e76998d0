// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/psychometric.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::study {
namespace {

/// `count` numbers from `least` to `most`, evenly spaced on a logarithmic scale.
std::vector<double> log_spaced(double least, double most, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    values.push_back(least * std::pow(most / least, static_cast<double>(i) / (count - 1)));
  return values;
}

/// The entropy of an answer that is right with this probability.
double doubt(double right) {
  const auto term = [](double share) { return share > 0 ? -share * std::log(share) : 0; };
  return term(right) + term(1 - right);
}

}  // namespace

double right_answers(double delay_ms, double jnd_ms, double slope, double lapse) {
  const double seen = 1 / (1 + std::pow(delay_ms / jnd_ms, -slope));
  return 0.5 * lapse + (1 - lapse) * (0.5 + 0.5 * seen);
}

PsychometricBelief::PsychometricBelief() : delays_ms_(log_spaced(0.1, 60, 49)) {
  for (const double jnd_ms : log_spaced(0.1, 100, 91))
    for (const double slope : {1.0, 1.5, 2.0, 3.0, 5.0})
      for (const double lapse : {0.0, 0.04, 0.1}) subjects_.push_back({jnd_ms, slope, lapse});
  share_.assign(subjects_.size(), 1.0 / static_cast<double>(subjects_.size()));
  for (const double delay_ms : delays_ms_) {
    auto& correct = correct_.emplace_back();
    auto& doubts = doubt_.emplace_back();
    for (const auto& subject : subjects_) {
      correct.push_back(right_answers(delay_ms, subject.jnd_ms, subject.slope, subject.lapse));
      doubts.push_back(doubt(correct.back()));
    }
  }
}

void PsychometricBelief::learn(double delay_ms, bool is_correct) {
  double sum = 0;
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    const auto& [jnd_ms, slope, lapse] = subjects_[i];
    const double right = right_answers(delay_ms, jnd_ms, slope, lapse);
    sum += share_[i] *= is_correct ? right : 1 - right;
  }
  for (double& share : share_) share /= sum;
}

// The expected entropy that is left is least where the answer is in doubt to us, but would not be
// if the subject were known: the mutual information is the difference.
double PsychometricBelief::most_telling_ms() const {
  double best_ms = delays_ms_[0], most = -1;
  for (std::size_t d = 0; d < delays_ms_.size(); ++d) {
    double right = 0, known = 0;
    for (std::size_t i = 0; i < share_.size(); ++i) {
      right += share_[i] * correct_[d][i];
      known += share_[i] * doubt_[d][i];
    }
    if (const double told = doubt(right) - known; told > most) {
      most = told;
      best_ms = delays_ms_[d];
    }
  }
  return best_ms;
}

PsychometricEstimate PsychometricBelief::estimate() const {
  PsychometricEstimate estimate;
  const auto at_share = [&](double wanted) {
    double sum = 0;
    for (std::size_t i = 0; i < subjects_.size(); ++i)
      if ((sum += share_[i]) >= wanted) return subjects_[i].jnd_ms;  // in the order of JNDs
    return subjects_.back().jnd_ms;
  };
  double log_jnd = 0;
  estimate.low_ms = at_share(0.025);
  estimate.high_ms = at_share(0.975);
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    log_jnd += share_[i] * std::log(subjects_[i].jnd_ms);
    estimate.slope += share_[i] * subjects_[i].slope;
    estimate.lapse += share_[i] * subjects_[i].lapse;
  }
  estimate.jnd_ms = std::exp(log_jnd);
  return estimate;
}

}  // namespace handcast::study
