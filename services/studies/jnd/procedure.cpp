// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/procedure.hpp"

#include <algorithm>
#include <numeric>

#include "services/lab/twin/random.hpp"

namespace handcast::study {
namespace {

constexpr double kRise = 3;  ///< steps up after a wrong answer, for one down after a right one
constexpr double kHighStart_ms = 40, kLowStart_ms = 0;
constexpr int kQuestTrials = 60;  ///< between those of one and of two staircases

}  // namespace

void Staircase::answer(bool is_correct) {
  if (trials_ > 0 && is_correct != was_correct_) {
    reversals_ms_.push_back(delay_ms_);
    step_ms_ = std::max(settings_.least_step_ms, 0.5 * step_ms_);
  }
  ++trials_;
  was_correct_ = is_correct;
  run_ = is_correct ? run_ + 1 : 0;
  if (run_ == settings_.run) {
    step_ms_ *= 2;
    run_ = 0;
  }
  delay_ms_ += is_correct ? -step_ms_ : kRise * step_ms_;
  delay_ms_ = std::clamp(delay_ms_, settings_.least_step_ms, settings_.most_ms);
}

double Staircase::mean_of_five_ms() const {
  const auto count = std::min<std::ptrdiff_t>(5, std::ssize(reversals_ms_));
  if (count == 0) return delay_ms_;
  return std::accumulate(reversals_ms_.end() - count, reversals_ms_.end(), 0.0) /
         static_cast<double>(count);
}

Interleaved::Interleaved(std::uint64_t seed) : seed_(seed) {
  for (const double start_ms : {kHighStart_ms, kLowStart_ms}) {
    Staircase::Settings settings;
    settings.start_ms = std::max(settings.least_step_ms, start_ms);
    stairs_.emplace_back(settings);
  }
  take_turn();
}

void Interleaved::answer(bool is_correct) {
  stairs_[turn_].answer(is_correct);
  ++trials_;
  take_turn();
}

void Interleaved::take_turn() {
  turn_ = twin::mixed(seed_ ^ twin::mixed(trials_)) & 1;
  if (stairs_[turn_].is_over()) turn_ = 1 - turn_;
}

void QuestPlus::answer(bool is_correct) {
  belief_.learn(next_ms_, is_correct);
  --trials_left_;
  choose();
}

void QuestPlus::choose() { next_ms_ = belief_.most_telling_ms(); }

std::unique_ptr<Procedure> make_procedure(ProcedureKind kind, std::uint64_t seed) {
  switch (kind) {
    case ProcedureKind::interleaved:
      return std::make_unique<Interleaved>(seed);
    case ProcedureKind::quest:
      return std::make_unique<QuestPlus>(kQuestTrials);
    case ProcedureKind::staircase:
      break;
  }
  return std::make_unique<Staircase>(Staircase::Settings());
}

}  // namespace handcast::study
