// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/subjects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "services/lab/perception/viewer.hpp"
#include "services/lab/twin/random.hpp"
#include "services/studies/base/comparison.hpp"

namespace handcast::study {
namespace {

/// Standard deviations of the logarithm of the JND: between people, and between the conditions of
/// one person. The ten of the paper differ by twice as much, of which the staircase has a part.
constexpr double kPeople = 0.35, kOccasions = 0.3;
constexpr double kLapse = 0.02;
constexpr double kWanted_ms = 0.5;  ///< how near estimates should be
constexpr double kMost = 1.959964;  ///< 95 % of normal errors are within so many deviations

twin::Random dice(std::uint64_t seed, int number) {
  return {
      static_cast<int>(twin::mixed(seed ^ twin::mixed(static_cast<std::uint64_t>(number))) >> 33),
      twin::Stream::person};
}

/// Errors of estimates, and how many there are.
struct Errors {
  std::vector<double> ms;
  double trials = 0;

  nlohmann::json to_json() const {
    const Summary summary = summary_of(ms);
    const auto count = static_cast<double>(ms.size());
    const double reach = kMost * summary.sample_sd / std::sqrt(count);
    const double room = kWanted_ms - std::abs(summary.mean);
    nlohmann::json json{{"trials", trials / count},
                        {"bias_ms", summary.mean},
                        {"bias_interval_ms", {summary.mean - reach, summary.mean + reach}},
                        {"median_error_ms", summary.median},
                        {"sd_ms", summary.sample_sd},
                        {"trials_for_half_ms", nullptr}};
    if (room > 0) {
      const double sessions = std::max(1.0, std::pow(kMost * summary.sample_sd / room, 2));
      json["trials_for_half_ms"] = std::ceil(sessions * trials / count);
    }
    return json;
  }
};

struct Tally {
  std::array<Errors, 2> last, mean_of_five, fit;  ///< by condition
  std::vector<Measured> measured;

  void add(const SessionResult& result, const SimulatedSubject& subject, int number) {
    const auto c = static_cast<std::size_t>(result.condition);
    const double true_ms = subject.jnd_ms(result.condition);
    const auto put = [&](Errors& errors, double estimate_ms) {
      errors.ms.push_back(estimate_ms - true_ms);
      errors.trials += result.trials;
    };
    put(last[c], result.jnd_ms);
    if (result.mean_of_five_ms) put(mean_of_five[c], *result.mean_of_five_ms);
    put(fit[c], result.fit.jnd_ms);
    measured.push_back({fmt::format("{}", number), std::string(kConditionNames[c]), result.jnd_ms});
  }

  nlohmann::json to_json() const {
    nlohmann::json json;
    for (std::size_t c = 0; c < kConditionNames.size(); ++c) {
      auto& estimates = json["estimates"][std::string(kConditionNames[c])];
      estimates = {{"procedure", last[c].to_json()}, {"fit", fit[c].to_json()}};
      if (!mean_of_five[c].ms.empty())
        estimates["mean_of_five_reversals"] = mean_of_five[c].to_json();
    }
    const auto comparison = compare(measured);
    if (comparison) json["comparison"] = study::to_json(*comparison, "ms");
    return json;
  }
};

Tally take_course(std::array<double, 2> jnd_ms, ProcedureKind procedure, int count,
                  std::uint64_t seed) {
  Tally tally;
  for (int number = 1; number <= count; ++number) {
    SimulatedSubject subject(jnd_ms, seed, number);
    Course course({.subject = number, .seed = seed, .procedure = procedure});
    while (const auto trial = course.trial()) course.answer(subject.answer(*trial));
    for (const auto& result : course.results())
      if (!result.is_training) tally.add(result, subject, number);
  }
  return tally;
}

}  // namespace

SimulatedSubject::SimulatedSubject(std::array<double, 2> jnd_ms, std::uint64_t seed, int number)
    : jnd_ms_(jnd_ms), seed_(twin::mixed(seed ^ twin::mixed(static_cast<std::uint64_t>(number)))) {
  const auto random = dice(seed, number);
  const double person = kPeople * random.normal(0);
  constexpr double kToMean = -0.5 * (kPeople * kPeople + kOccasions * kOccasions);
  for (std::size_t c = 0; c < jnd_ms_.size(); ++c)
    jnd_ms_[c] *= std::exp(kToMean + person + kOccasions * random.normal(1 + c));
}

Answer SimulatedSubject::answer(const Trial& trial) {
  const twin::Random random(static_cast<int>(seed_ >> 33), twin::Stream::person);
  const double right = perception::picks_late(trial.delay_ms, jnd_ms(trial.condition), kLapse);
  const bool is_correct = random.uniform(1000 + answers_) < right;
  ++answers_;
  return {.picks_first = is_correct == trial.is_late_first};
}

std::array<double, 2> predicted_jnds_ms(std::span<const double> speeds_deg_s) {
  return {perception::jnd_ms(speeds_deg_s, {.edges = 1}),
          perception::jnd_ms(speeds_deg_s, {.edges = 0})};
}

nlohmann::json simulate_subjects(std::array<double, 2> jnd_ms, int count, std::uint64_t seed) {
  nlohmann::json json{{"subjects", count}, {"seed", seed}};
  for (std::size_t c = 0; c < kConditionNames.size(); ++c)
    json["predicted_jnd_ms"][std::string(kConditionNames[c])] = jnd_ms[c];
  for (const auto kind :
       {ProcedureKind::staircase, ProcedureKind::interleaved, ProcedureKind::quest})
    json["procedures"][std::string(kProcedureNames[static_cast<std::size_t>(kind)])] =
        take_course(jnd_ms, kind, count, seed).to_json();
  // As a study with the paper's procedure reports it.
  json["comparison"] = json["procedures"]["staircase"]["comparison"];
  return json;
}

}  // namespace handcast::study
