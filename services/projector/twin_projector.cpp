// SPDX-License-Identifier: Apache-2.0
#include "services/projector/light_clock.hpp"

namespace handcast::projector {
namespace {

/// The twin's projector. Only its timing is simulated here; its light is the published message,
/// which the observer scores.
class TwinProjector final : public Projector {
 public:
  explicit TwinProjector(const config::Projector& settings) : clock_(settings) {}
  Result<PresentTimes> present(const renderer::Frame&, std::int64_t, const renderer::LightTable&,
                               Deadline deadline) override {
    return clock_.take(deadline);
  }

 private:
  LightClock clock_;
};

}  // namespace

Result<std::unique_ptr<Projector>> open_twin(const config::Rig& rig, const calib::Calibration&) {
  return std::make_unique<TwinProjector>(rig.projector);
}

}  // namespace handcast::projector
