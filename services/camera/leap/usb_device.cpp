// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/usb_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "services/camera/leap/usb_handle.hpp"

namespace handcast::camera::leap {
namespace {

constexpr std::uint16_t kVendor = 0xf182, kProduct = 0x0003;
constexpr int kControlInterface = 0, kOpenedStreamingInterface = 1;
constexpr unsigned kPatience_ms = 500;

std::string port_of(libusb_device* device) {
  std::array<std::uint8_t, 8> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string text = fmt::format("{}", libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i)
    text += fmt::format("{}{}", i ? '.' : '-', ports[static_cast<std::size_t>(i)]);
  return text;
}

/// Calls `use` with each controller, until it returns true.
template <class Use>
void for_each_controller(libusb_context* context, const Use& use) {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context, &list);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != 0 || descriptor.idVendor != kVendor ||
        descriptor.idProduct != kProduct)
      continue;
    if (use(list[i])) break;
  }
  if (count >= 0) libusb_free_device_list(list, 1);
}

std::span<const std::uint8_t> extra_of(const libusb_config_descriptor& config, int interface) {
  if (interface >= config.bNumInterfaces || config.interface[interface].num_altsetting < 1)
    return {};
  const auto& first = config.interface[interface].altsetting[0];
  return {first.extra, static_cast<std::size_t>(std::max(first.extra_length, 0))};
}

}  // namespace

UsbHandle::~UsbHandle() {
  if (device) {
    libusb_release_interface(device, kOpenedStreamingInterface);
    libusb_release_interface(device, kControlInterface);
    libusb_close(device);
  }
  if (context) libusb_exit(context);
}

Error usb_error(int code, const UsbHandle& handle, std::string_view doing) {
  const auto where = fmt::format("the controller at USB port {}", handle.port);
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return {Errc::disconnected, fmt::format("{} is unplugged", where)};
    case LIBUSB_ERROR_ACCESS:
      return {Errc::unavailable,
              fmt::format("{}: access is denied; `scripts/setup --udev` installs the rule that "
                          "permits it, then plug the controller in again",
                          where)};
    case LIBUSB_ERROR_BUSY:
      return {
          Errc::unavailable,
          fmt::format("another program uses {}; if it is Ultraleap's service, stop that", where)};
    case LIBUSB_ERROR_TIMEOUT:
      return {Errc::timeout, fmt::format("{} does not answer ({})", where, doing)};
    case LIBUSB_ERROR_PIPE:
      return {Errc::bad_data, fmt::format("{} refuses {}", where, doing)};
    default:
      return {Errc::unavailable,
              fmt::format("{}: {} failed: {}", where, doing, libusb_strerror(code))};
  }
}

std::vector<std::string> controller_ports() {
  std::vector<std::string> ports;
  UsbHandle handle;
  if (libusb_init(&handle.context) != 0) return ports;
  for_each_controller(handle.context, [&](libusb_device* device) {
    ports.push_back(port_of(device));
    return false;
  });
  std::ranges::sort(ports);
  return ports;
}

Result<UsbDevice> UsbDevice::open(const std::string& port) {
  auto handle = std::make_shared<UsbHandle>();
  handle->port = port;
  int code = libusb_init(&handle->context);
  if (code == 0) code = LIBUSB_ERROR_NO_DEVICE;
  for_each_controller(handle->context, [&](libusb_device* device) {
    if (port_of(device) != port) return false;
    code = libusb_open(device, &handle->device);
    return true;
  });
  if (code == 0) code = libusb_set_auto_detach_kernel_driver(handle->device, 1);
  for (const int interface : {kControlInterface, kOpenedStreamingInterface})
    if (code == 0) code = libusb_claim_interface(handle->device, interface);
  if (code == 0) return UsbDevice(std::move(handle));
  auto error = usb_error(code, *handle, "opening it");
  error.code = Errc::unavailable;
  return tl::make_unexpected(error);
}

Result<int> UsbDevice::carry_out(const ControlTransfer& transfer, std::uint8_t* data) {
  const int done =
      libusb_control_transfer(handle_->device, transfer.request_type, transfer.request,
                              transfer.value, transfer.index, data, transfer.length, kPatience_ms);
  if (done >= 0) return done;
  return tl::make_unexpected(
      usb_error(done, *handle_,
                fmt::format("request {:#x} with value {:#06x} to {:#06x}", transfer.request,
                            transfer.value, transfer.index)));
}

Result<void> UsbDevice::write(const ControlTransfer& transfer) {
  auto data = transfer.data;
  const auto done = carry_out(transfer, data.data());
  return done ? Result<void>() : tl::make_unexpected(done.error());
}

Result<std::vector<std::uint8_t>> UsbDevice::read(const ControlTransfer& transfer) {
  std::vector<std::uint8_t> data(transfer.length);
  const auto done = carry_out(transfer, data.data());
  if (!done) return tl::make_unexpected(done.error());
  data.resize(static_cast<std::size_t>(*done));
  return data;
}

Result<StreamDescription> UsbDevice::describe() const {
  libusb_config_descriptor* config = nullptr;
  const int code = libusb_get_active_config_descriptor(libusb_get_device(handle_->device), &config);
  if (code != 0) return tl::make_unexpected(usb_error(code, *handle_, "reading its description"));
  auto description = parse_descriptors(extra_of(*config, kControlInterface),
                                       extra_of(*config, kOpenedStreamingInterface));
  libusb_free_config_descriptor(config);
  return description;
}

Result<void> UsbDevice::clear_halt() {
  const int code = libusb_clear_halt(handle_->device, kImageEndpoint);
  return code == 0 ? Result<void>()
                   : tl::make_unexpected(usb_error(code, *handle_, "ending a halt"));
}

Result<void> UsbDevice::reset() {
  const int code = libusb_reset_device(handle_->device);
  return code == 0 ? Result<void>() : tl::make_unexpected(usb_error(code, *handle_, "a reset"));
}

}  // namespace handcast::camera::leap
