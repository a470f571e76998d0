// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/service_state.hpp"

namespace handcast::supervisor {
namespace {

struct Shown {
  State operator()(const worker::Stopped&) const { return State::stopped; }
  State operator()(const worker::Failed&) const { return State::failed; }
  State operator()(const worker::Held&) const { return State::starting; }
  State operator()(const worker::Waiting& waiting) const {
    return waiting.degraded ? State::degraded : State::starting;
  }
  State operator()(const worker::Starting&) const { return State::starting; }
  State operator()(const worker::AwaitingMessage&) const { return State::starting; }
  State operator()(const worker::Ready&) const { return State::ready; }
  State operator()(const worker::Killed&) const { return State::starting; }
  State operator()(const worker::Stopping&) const { return State::stopping; }
  State operator()(const worker::AwaitingStandby&) const { return State::stopping; }
};

}  // namespace

State shown(const Worker& worker) { return std::visit(Shown{}, worker); }

const Life* life_of(const Worker& worker) {
  return std::visit(
      [](const auto& state) -> const Life* {
        if constexpr (requires { state.life; })
          return &state.life;
        else
          return nullptr;
      },
      worker);
}

bool is_running(const Standby& standby) {
  return !std::holds_alternative<standby::None>(standby) &&
         !std::holds_alternative<standby::Due>(standby);
}

}  // namespace handcast::supervisor
