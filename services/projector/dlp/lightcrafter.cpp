// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "services/projector/dlp/choose_device.hpp"
#include "services/projector/dlp/dlp_controller.hpp"
#include "services/projector/dlp/model.hpp"
#include "services/projector/dlp/protocol/payload.hpp"

namespace handcast::dlp {

namespace {

using protocol::Bytes;
using protocol::Command;
using protocol::Controller;
using protocol::Status;

constexpr std::uint8_t kNormalPower = 0, kPowerBits = 3;
constexpr std::uint8_t kEnableBits = 0x0f;
constexpr std::uint8_t kLeds = protocol::kRed | protocol::kGreen | protocol::kBlue;

class LightCrafter final : public DlpController {
 public:
  LightCrafter(std::unique_ptr<HidDevice> device, const HidInfo& info, const config::Rig& rig)
      : info_(info),
        link_(std::move(device), *controller_of(info)),
        model_(link_.controller() == Controller::dlpc900 ? make_dlpc900() : make_dlpc350()),
        dlp_(rig.dlp),
        currents_({dlp_.red, dlp_.green, dlp_.blue}),
        enables_(dlp_.limit > 0 ? protocol::enables_of(currents_) : 0),
        sequence_(sequence_for(rig)) {}

  Result<std::string> identify(Deadline deadline) override;
  Result<void> darken(Deadline deadline) override;
  Result<Health> tend(Deadline deadline) override;

 private:
  Result<Sequence> sequence_for(const config::Rig& rig) const;
  bool shows_patterns() const { return dlp_.mode == config::DlpMode::pattern; }
  Result<Status> read_status(Deadline deadline);
  Result<bool> is_awake(Deadline deadline);
  Result<bool> keeps_settings(Deadline deadline);
  Result<std::string> what_is_lost(const Status& status, bool signal, Deadline deadline);
  Result<std::string> light(bool signal, std::vector<std::string>& events, Deadline deadline);
  Result<void> switch_on(Deadline deadline);
  Result<void> start_sequence(Deadline deadline);
  Bytes levels_of(const protocol::Currents& currents) const {
    return protocol::encode_currents(protocol::is_inverted(dlp_.signal, link_.controller()),
                                     currents, dlp_.limit);
  }

  HidInfo info_;
  Link link_;
  std::unique_ptr<Model> model_;
  config::Dlp dlp_;
  protocol::Currents currents_;
  std::uint8_t enables_;
  Result<Sequence> sequence_;  ///< reported after the safe state, only in pattern mode
  bool lit_ = false;
};

Result<Sequence> LightCrafter::sequence_for(const config::Rig& rig) const {
  if (rig.dlp.trigger_in && link_.controller() == Controller::dlpc900)
    return fail(Errc::bad_config,
                "dlp.trigger_in: the DLPC900 starts the patterns of a video signal by its vertical "
                "sync only; set it to false");
  return make_sequence(link_.controller(), rig.projector, enables_ & kLeds);
}

Result<std::string> LightCrafter::identify(Deadline deadline) {
  const auto data = link_.read(Command::version, 4, deadline);
  if (!data) return tl::make_unexpected(data.error());
  const auto version = protocol::decode_version(*data);
  if (!version) return tl::make_unexpected(version.error());
  return fmt::format("{} (serial {}, {}), firmware {}", protocol::name_of(link_.controller()),
                     info_.serial.empty() ? "none" : info_.serial, info_.path, *version);
}

/// The LEDs go first. A controller without a sequence may refuse to stop it.
Result<void> LightCrafter::darken(Deadline deadline) {
  lit_ = false;
  auto off = link_.write(Command::led_enables, {{0}}, deadline);
  if (!off && off.error().code == Errc::disconnected) return off;
  const auto stopped = link_.write(Command::pattern_display, {{protocol::kStop}}, deadline);
  if (!stopped && stopped.error().code != Errc::unavailable && off) off = stopped;
  if (auto without = link_.write(Command::led_currents, levels_of({}), deadline); !without && off)
    off = without;
  const auto enables = link_.read(Command::led_enables, 1, deadline);
  if (!enables && off) off = tl::make_unexpected(enables.error());
  if (enables && (enables->front() & kEnableBits) != 0 && off)
    off = fail(Errc::unavailable, "its LEDs stay on although they were switched off");
  return off;
}

Result<Status> LightCrafter::read_status(Deadline deadline) {
  Status status;
  for (const auto& [command, byte] : {std::pair{Command::hardware_status, &status.hardware},
                                      {Command::system_status, &status.system},
                                      {Command::main_status, &status.main}}) {
    const auto data = link_.read(command, 1, deadline);
    if (!data) return tl::make_unexpected(data.error());
    *byte = data->front();
  }
  return status;
}

/// Wakes it if it is in standby.
Result<bool> LightCrafter::is_awake(Deadline deadline) {
  const auto power = link_.read(Command::power, 1, deadline);
  if (!power) return tl::make_unexpected(power.error());
  if ((power->front() & kPowerBits) == kNormalPower) return true;
  const auto woken = link_.write(Command::power, {{kNormalPower}}, deadline);
  if (!woken) return tl::make_unexpected(woken.error());
  return false;
}

/// A controller that resets itself returns to the currents of its firmware, which may be above the
/// limit.
Result<bool> LightCrafter::keeps_settings(Deadline deadline) {
  const auto currents = link_.read(Command::led_currents, 3, deadline);
  if (!currents) return tl::make_unexpected(currents.error());
  const auto enables = link_.read(Command::led_enables, 1, deadline);
  if (!enables) return tl::make_unexpected(enables.error());
  const auto wanted = levels_of(currents_);
  return std::equal(wanted.begin(), wanted.end(), currents->begin()) &&
         (enables->front() & kEnableBits) == enables_;
}

/// Why a light that is on must go off; "" if it may stay.
Result<std::string> LightCrafter::what_is_lost(const Status& status, bool signal,
                                               Deadline deadline) {
  if (!signal) return "the video signal is lost";
  const auto keeps = keeps_settings(deadline);
  if (!keeps) return tl::make_unexpected(keeps.error());
  if (!*keeps) return "it has lost its settings; has it restarted?";
  if (shows_patterns() && !protocol::is_running(status)) return "its sequence has stopped";
  return "";
}

Result<void> LightCrafter::switch_on(Deadline deadline) {
  if (auto set = link_.write(Command::led_currents, levels_of(currents_), deadline); !set)
    return set;
  if (auto set = link_.write(Command::led_enables, {{enables_}}, deadline); !set) return set;
  const auto keeps = keeps_settings(deadline);
  if (!keeps) return tl::make_unexpected(keeps.error());
  if (!*keeps) return fail(Errc::unavailable, "it does not take the currents of its LEDs");
  return shows_patterns() ? start_sequence(deadline) : Result<void>();
}

/// A DLPC350 that comes from the video mode may need a second command.
Result<void> LightCrafter::start_sequence(Deadline deadline) {
  constexpr int kTries = 2;
  for (int i = 0; i < kTries; ++i) {
    if (auto begun = link_.write(Command::pattern_display, {{protocol::kStart}}, deadline); !begun)
      return begun;
    const auto status = read_status(deadline);
    if (!status) return tl::make_unexpected(status.error());
    if (protocol::is_running(*status)) break;
  }
  return {};
}

/// Returns what the light waits for; "" if it is on.
Result<std::string> LightCrafter::light(bool signal, std::vector<std::string>& events,
                                        Deadline deadline) {
  const auto awake = is_awake(deadline);
  if (!awake) return tl::make_unexpected(awake.error());
  if (!*awake) return "its end of standby";
  if (!signal) return "a video signal";
  Result<std::string> waits_for = "";
  if (shows_patterns())
    waits_for =
        model_->prepare(link_, *sequence_, {dlp_.trigger_in, dlp_.trigger_out}, events, deadline);
  else if (auto shown = model_->show_video(link_, deadline); !shown)
    return tl::make_unexpected(shown.error());
  if (!waits_for || !waits_for->empty()) return waits_for;
  if (auto on = switch_on(deadline); !on) return tl::make_unexpected(on.error());
  lit_ = true;
  events.push_back(enables_ == 0 ? "it shows the picture, but no LED has a current"
                                 : "its LEDs are on");
  return "";
}

Result<Health> LightCrafter::tend(Deadline deadline) {
  if (shows_patterns() && !sequence_) return tl::make_unexpected(sequence_.error());
  const auto status = read_status(deadline);
  if (!status) return tl::make_unexpected(status.error());
  const auto signal = model_->has_signal(link_, *status, deadline);
  if (!signal) return tl::make_unexpected(signal.error());

  Health health;
  for (const auto fault : protocol::faults_of(link_.controller(), *status))
    health.faults.emplace_back(fault);
  if (lit_) {
    const auto lost = what_is_lost(*status, *signal, deadline);
    if (!lost) return tl::make_unexpected(lost.error());
    if (lost->empty()) return health;
    health.events.push_back(*lost + "; its LEDs are switched off");
    if (auto dark = darken(deadline); !dark) return tl::make_unexpected(dark.error());
  }
  auto waits_for = light(*signal, health.events, deadline);
  if (!waits_for) return tl::make_unexpected(waits_for.error());
  health.waits_for = std::move(*waits_for);
  return health;
}

}  // namespace

Result<std::unique_ptr<DlpController>> open_lightcrafter(const config::Rig& rig) {
  const auto info = choose_device(rig.dlp.device);
  if (!info) return tl::make_unexpected(info.error());
  auto device = HidDevice::open(*info);
  if (!device) return tl::make_unexpected(device.error());
  return std::make_unique<LightCrafter>(std::move(*device), *info, rig);
}

}  // namespace handcast::dlp
