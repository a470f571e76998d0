// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "services/studies/jnd/psychometric.hpp"

namespace handcast::study {

/// Decides which delay is shown next, from the answers so far, and when it is enough.
class Procedure {
 public:
  virtual ~Procedure() = default;
  /// The delay of the next trial, ms, more than 0.
  virtual double next_ms() const = 0;
  /// Whether the subject has picked the late light in that trial.
  virtual void answer(bool is_correct) = 0;
  virtual bool is_over() const = 0;
  /// The delay at which the subject would be right in 75 % of the trials, ms, by the answers so
  /// far.
  virtual double jnd_ms() const = 0;
};

/// The staircase of the paper: every right answer takes one step off the delay, every wrong one
/// adds three, so that it settles where 75 % are right. The step is halved at each reversal, down
/// to a floor.
class Staircase final : public Procedure {
 public:
  struct Settings {
    double start_ms = 20, step_ms = 1.6;
    double least_step_ms = 0.01;  ///< as in the program of the authors
    int reversals = 10;           ///< after which it is over
    int run = 20;                 ///< so many right answers in a row double the step
    double most_ms = 200;         ///< longer delays are not shown
    int most_trials = 400;        ///< it is over then in any case
  };
  explicit Staircase(const Settings& settings)
      : settings_(settings), delay_ms_(settings.start_ms), step_ms_(settings.step_ms) {}

  double next_ms() const override { return delay_ms_; }
  void answer(bool is_correct) override;
  bool is_over() const override {
    return std::ssize(reversals_ms_) >= settings_.reversals || trials_ >= settings_.most_trials;
  }
  /// The delay that it has come to, as in the paper.
  double jnd_ms() const override { return delay_ms_; }
  /// The mean of the delays at the last five reversals.
  double mean_of_five_ms() const;
  int reversals() const { return static_cast<int>(reversals_ms_.size()); }

 private:
  Settings settings_;
  double delay_ms_, step_ms_;
  std::vector<double> reversals_ms_;
  int trials_ = 0, run_ = 0;
  bool was_correct_ = true;
};

/// Two staircases in turn, of which a coin decides, from 40 ms and from 0, as in the protocol that
/// the paper shortens: the subject cannot foresee the next trial. The JND is the mean of both.
class Interleaved final : public Procedure {
 public:
  explicit Interleaved(std::uint64_t seed);
  double next_ms() const override { return stairs_[turn_].next_ms(); }
  void answer(bool is_correct) override;
  bool is_over() const override { return stairs_[0].is_over() && stairs_[1].is_over(); }
  double jnd_ms() const override { return 0.5 * (stairs_[0].jnd_ms() + stairs_[1].jnd_ms()); }

 private:
  void take_turn();
  std::uint64_t seed_, trials_ = 0;
  std::vector<Staircase> stairs_;
  std::size_t turn_ = 0;
};

/// QUEST+ (Watson 2017): shows the delay whose answer is expected to tell most about the subject's
/// psychometric function.
class QuestPlus final : public Procedure {
 public:
  explicit QuestPlus(int trials) : trials_left_(trials) { choose(); }
  double next_ms() const override { return next_ms_; }
  void answer(bool is_correct) override;
  bool is_over() const override { return trials_left_ <= 0; }
  double jnd_ms() const override { return belief_.estimate().jnd_ms; }

 private:
  void choose();
  PsychometricBelief belief_;
  int trials_left_;
  double next_ms_ = 0;
};

inline constexpr std::string_view kProcedureNames[] = {"staircase", "interleaved", "quest"};
enum class ProcedureKind { staircase, interleaved, quest };

std::unique_ptr<Procedure> make_procedure(ProcedureKind kind, std::uint64_t seed);

}  // namespace handcast::study
