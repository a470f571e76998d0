// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

namespace handcast::study {

/// How likely a subject is right when the light is late by `delay_ms`, of two intervals: a logistic
/// function of the logarithm of the delay, from chance to 1 - lapse / 2.
double right_answers(double delay_ms, double jnd_ms, double slope, double lapse);

/// The estimate of a subject's psychometric function.
struct PsychometricEstimate {
  /// The delay with 75 % right answers (without lapses), ms: the geometric mean of the
  /// belief, and its central 95 %.
  /// @{
  double jnd_ms = 0, low_ms = 0, high_ms = 0;
  /// @}
  double slope = 0, lapse = 0;  ///< the means of the belief
};

/// What is believed of a subject's psychometric function, given answers: a probability by JND,
/// slope and lapse on a grid (Watson 2017; Kontsevich and Tyler 1999).
class PsychometricBelief {
 public:
  /// Before the first answer: JNDs from 0.1 to 100 ms are alike on a logarithmic scale.
  PsychometricBelief();

  /// Adds an answer to a trial with that delay, more than 0.
  void learn(double delay_ms, bool is_correct);
  /// The delay whose answer is expected to leave the least entropy, of those from 0.1 to 60 ms.
  double most_telling_ms() const;
  PsychometricEstimate estimate() const;

 private:
  struct Subject {
    double jnd_ms, slope, lapse;
  };
  std::vector<Subject> subjects_;
  std::vector<double> share_;      ///< by subject, sum 1
  std::vector<double> delays_ms_;  ///< that most_telling_ms() may choose
  /// By delay and subject: how likely the answer is right, and its entropy.
  /// @{
  std::vector<std::vector<double>> correct_, doubt_;
  /// @}
};

}  // namespace handcast::study
