// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/session.hpp"

#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"
#include "services/camera/leap/bring_up.hpp"
#include "services/camera/leap/controller.hpp"

namespace handcast::camera::leap {
namespace {

Result<void> write_all(UsbDevice& device, const std::vector<ControlTransfer>& transfers) {
  for (const auto& transfer : transfers)
    if (auto written = device.write(transfer); !written) return written;
  return {};
}

Result<void> carry_out(UsbDevice& device, const ControlTransfer& transfer) {
  if (!transfer.reads()) return device.write(transfer);
  const auto read = device.read(transfer);
  return read ? Result<void>() : tl::make_unexpected(read.error());
}

Result<void> bring_up(UsbDevice& device, const std::string& file) {
  const auto steps = load_bring_up(file);
  if (!steps) return fail_in("leap.bring_up", steps.error());
  for (const auto& step : *steps) {
    if (step.pause_ns > 0) sleep_until_ns(now_ns() + step.pause_ns);
    if (const auto done = carry_out(device, step.transfer); !done)
      return fail_in(fmt::format("bring-up, line {}", step.line), done.error());
  }
  return {};
}

/// Agrees on a mode. The bytes of the largest payload.
Result<std::size_t> negotiate(UsbDevice& device, const StreamMode& mode) {
  // What an ended program has started still streams.
  if (auto cleared = device.clear_halt(); !cleared) return tl::make_unexpected(cleared.error());
  if (auto asked = device.write(probe(mode)); !asked) return tl::make_unexpected(asked.error());
  const auto probed = device.read(read_probe());
  if (!probed) return tl::make_unexpected(probed.error());
  auto bytes = payload_bytes_of(*probed, mode);
  if (!bytes) return bytes;
  if (auto begun = device.write(commit(*probed)); !begun) return tl::make_unexpected(begun.error());
  return bytes;
}

/// The controller that is wanted, reset if asked for.
Result<Controller> open(const std::string& wanted, bool resets) {
  auto controller = open_controller(wanted);
  if (!controller || !resets) return controller;
  if (auto done = controller->device.reset(); !done) return tl::make_unexpected(done.error());
  const auto port = controller->port;
  controller = tl::make_unexpected(Error{});  // closes it
  return open_controller(port);
}

/// Everything up to the stream. The bytes of the largest payload.
Result<std::size_t> set_up(UsbDevice& device, const config::Camera& settings,
                           const StreamMode& mode) {
  const auto controls = transfers_of(settings.leap, settings.exposure_ms, mode);
  if (!controls) return tl::make_unexpected(controls.error());
  if (auto done = bring_up(device, settings.leap.bring_up); !done)
    return tl::make_unexpected(done.error());
  if (auto done = write_all(device, *controls); !done) return tl::make_unexpected(done.error());
  return negotiate(device, mode);
}

}  // namespace

Result<std::unique_ptr<Session>> Session::start(const std::string& wanted,
                                                const config::Camera& settings,
                                                const calib::PlacedCamera& camera,
                                                std::shared_ptr<Mailbox> mailbox, bool resets) {
  auto controller = open(wanted, resets);
  if (!controller) return tl::make_unexpected(controller.error());
  if (auto ours =
          calib::check_device("camera", camera.device, {controller->serial, controller->port});
      !ours)
    return tl::make_unexpected(ours.error());
  const auto description = controller->device.describe();
  if (!description) return tl::make_unexpected(description.error());
  const auto mode =
      mode_of(*description, camera.model.width_px, camera.model.height_px, settings.rate_hz);
  if (!mode) return tl::make_unexpected(mode.error());
  const auto payload_bytes = set_up(controller->device, settings, *mode);
  if (!payload_bytes) return tl::make_unexpected(payload_bytes.error());
  const StreamFacts facts{.frame_bytes = mode->bytes(),
                          .payload_bytes = *payload_bytes,
                          .period_ns = std::int64_t{100} * mode->ticks,
                          .clock_hz = description->clock_hz,
                          .exposure_ns = ms_to_ns(settings.exposure_ms),
                          .delivery_ns = ms_to_ns(settings.delivery_ms)};
  std::unique_ptr<Session> session(
      new Session(controller->serial.empty() ? controller->port : controller->serial, *mode, facts,
                  std::move(mailbox)));
  auto stream = UsbStream::start(controller->device, session->receiver_, *payload_bytes,
                                 settings.process.priority);
  if (!stream) return tl::make_unexpected(stream.error());
  session->stream_ = std::move(*stream);
  return session;
}

}  // namespace handcast::camera::leap
