// SPDX-License-Identifier: Apache-2.0
#include "tests/services/projector/dlp/emulated_hid.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>

#include "tests/emulation/glib_loop.hpp"

namespace handcast::test {
namespace {

/// Reports of 64 bytes without numbers, both ways, of a vendor's own usage.
constexpr std::array<std::uint8_t, 27> kDescriptor{
    0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08,
    0x95, 0x40, 0x09, 0x01, 0x81, 0x02, 0x95, 0x40, 0x09, 0x01, 0x91, 0x02, 0xc0};

constexpr const char* kUsb = "/devices/pci0000:00/0000:00:14.0/usb1/1-2";
constexpr const char* kNode = "/dev/hidraw0";

std::string description_of(std::uint16_t product_id, const std::string& serial) {
  std::string descriptor;
  for (const auto byte : kDescriptor) descriptor += fmt::format("{:02X}", byte);
  const auto hid = fmt::format("{}/1-2:1.0/0003:0451:{:04X}.0001", kUsb, product_id);
  return fmt::format(
      "P: {0}\nN: bus/usb/001/002\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=001\n"
      "E: DEVNUM=002\nE: PRODUCT=451/{1:x}/100\nA: idVendor=0451\\n\nA: idProduct={1:04x}\\n\n"
      "A: bcdDevice=0100\\n\nA: manufacturer=Texas Instruments\\n\nA: product=DLP\\n\n"
      "A: serial={2}\\n\nA: busnum=1\\n\nA: devnum=2\\n\n\n"
      "P: {0}/1-2:1.0\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n"
      "A: bInterfaceClass=03\\n\n\n"
      "P: {3}\nE: SUBSYSTEM=hid\nE: DRIVER=hid-generic\nE: HID_ID=0003:00000451:0000{1:04X}\n"
      "E: HID_NAME=Texas Instruments DLP\nE: HID_UNIQ={2}\n"
      "A: uevent=DRIVER=hid-generic\\nHID_ID=0003:00000451:0000{1:04X}\\n"
      "HID_NAME=Texas Instruments DLP\\nHID_PHYS=usb-2/input0\\nHID_UNIQ={2}\\n\n"
      "H: report_descriptor={4}\n\n"
      "P: {3}/hidraw/hidraw0\nN: hidraw0\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/hidraw0\n"
      "E: MAJOR=243\nE: MINOR=0\nA: dev=243:0\\n\nL: device=../../../0003:0451:{1:04X}.0001\n\n",
      kUsb, product_id, serial, hid, descriptor);
}

/// Answers what hidapi asks when it opens the device.
gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, void*) {
  auto* argument = umockdev_ioctl_client_get_arg(client);
  const auto request = umockdev_ioctl_client_get_request(client);
  if (request == HIDIOCGRDESCSIZE) {
    auto* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(int), nullptr);
    const int size = kDescriptor.size();
    std::array<std::uint8_t, sizeof size> bytes;
    std::memcpy(bytes.data(), &size, sizeof size);
    umockdev_ioctl_data_update(data, 0, bytes.data(), static_cast<gint>(bytes.size()));
  } else if (request == HIDIOCGRDESC) {
    auto* data =
        umockdev_ioctl_data_resolve(argument, 0, sizeof(hidraw_report_descriptor), nullptr);
    auto descriptor = kDescriptor;
    umockdev_ioctl_data_update(data, 4, descriptor.data(), static_cast<gint>(descriptor.size()));
  } else {
    umockdev_ioctl_client_complete(client, -1, ENOTTY);
    return TRUE;
  }
  umockdev_ioctl_client_complete(client, 0, 0);
  return TRUE;
}

}  // namespace

/// What needs a GLib main loop of its own: the answers to ioctls.
struct EmulatedHid::Testbed {
  UMockdevTestbed* testbed = umockdev_testbed_new();
  UMockdevIoctlBase* ioctls = umockdev_ioctl_base_new();
  GlibLoop loop;

  explicit Testbed(const std::string& description) {
    g_signal_connect(ioctls, "handle-ioctl", G_CALLBACK(on_ioctl), nullptr);
    GError* error = nullptr;
    bool is_made = false;
    loop.with([&] {
      is_made = umockdev_testbed_attach_ioctl(testbed, kNode, ioctls, &error) &&
                umockdev_testbed_add_from_string(testbed, description.c_str(), &error);
    });
    if (!is_made) throw std::runtime_error(error->message);
    loop.start();
  }
  ~Testbed() {
    loop.stop();
    umockdev_testbed_detach_ioctl(testbed, kNode, nullptr);
    g_object_unref(ioctls);
    g_object_unref(testbed);
  }
};

EmulatedHid::EmulatedHid(std::uint16_t product_id, const std::string& serial,
                         std::function<void(const NumberedReport&)> on_report)
    : testbed_(std::make_unique<Testbed>(description_of(product_id, serial))),
      on_report_(std::move(on_report)),
      fd_(umockdev_testbed_get_dev_fd(testbed_->testbed, kNode)),
      device_([this] { serve(); }) {}

// The testbed closes the descriptor, so its place must not become free.
EmulatedHid::~EmulatedHid() {
  ends_ = true;
  device_.join();
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, fd_);
  close(nothing);
  for (const auto* path : {"/1-2:1.0", ""})
    umockdev_testbed_remove_device(testbed_->testbed, (std::string("/sys") + kUsb + path).c_str());
}

void EmulatedHid::send(const void* bytes, std::size_t count) const {
  if (write(fd_, bytes, count) != static_cast<ssize_t>(count)) std::perror("emulated device");
}

void EmulatedHid::serve() {
  NumberedReport report{};
  std::size_t count = 0;
  while (!ends_) {
    pollfd readable{.fd = fd_, .events = POLLIN, .revents = 0};
    if (stalled_ || poll(&readable, 1, 10) <= 0 || (readable.revents & POLLIN) == 0) {
      usleep(1000);
      continue;
    }
    const auto more = read(fd_, report.data() + count, report.size() - count);
    if (more <= 0) continue;
    count += static_cast<std::size_t>(more);
    if (count < report.size()) continue;
    count = 0;
    on_report_(report);
  }
}

}  // namespace handcast::test
