// SPDX-License-Identifier: Apache-2.0
#include "tests/services/camera/leap/emulated_leap.hpp"

#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "ipc/base/clock.hpp"
#include "tests/emulation/glib_loop.hpp"

namespace handcast::test {
namespace {

constexpr const char* kPath = "/devices/pci0000:00/0000:00:14.0/usb1/1-2";
constexpr const char* kNode = "/dev/bus/usb/001/002";
constexpr std::size_t kSetupBytes = 8;

std::string description_of(const std::vector<std::uint8_t>& configuration) {
  // USB 2.00, class of associated interfaces, f182:0003, no serial number.
  std::string bytes = "12010002EF02014082F10300000001020001";
  for (const auto byte : configuration) bytes += fmt::format("{:02X}", byte);
  return fmt::format(
      "P: {}\nN: bus/usb/001/002\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=002\n"
      "E: DEVNAME={}\nE: DEVTYPE=usb_device\nE: MAJOR=189\nE: MINOR=1\n"
      "A: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=2\\n\nA: speed=480\\n\n"
      "A: idVendor=f182\\n\nA: idProduct=0003\\n\nH: descriptors={}\n\n",
      kPath, kNode, bytes);
}

}  // namespace

/// The calls of usbfs. All members that the loop's thread uses are guarded by the mutex of the
/// device.
struct EmulatedLeap::Usbfs {
  /// A transfer that the driver has handed over.
  struct Urb {
    UMockdevIoctlClient* client = nullptr;  ///< only compared
    UMockdevIoctlData* data = nullptr;      ///< owned

    usbdevfs_urb& urb() const { return *reinterpret_cast<usbdevfs_urb*>(data->data); }
    std::span<std::uint8_t> buffer() const {
      return {static_cast<std::uint8_t*>(urb().buffer),
              static_cast<std::size_t>(urb().buffer_length)};
    }
  };

  explicit Usbfs(EmulatedLeap& owner);
  ~Usbfs();

  void add() const;
  void remove() const;

  gboolean on_ioctl(UMockdevIoctlClient* client);
  void on_vanished(const UMockdevIoctlClient* client);
  void submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
  void answer_control(Urb urb);
  void discard(UMockdevIoctlClient* client, const UMockdevIoctlData* argument);
  void reap(UMockdevIoctlClient* client);
  bool reap_now(UMockdevIoctlClient* client);
  void pump();
  void finish(Urb urb, int status, std::size_t bytes);
  void answer_held();
  void disconnect();

  static gboolean ioctl_of(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* usbfs) {
    auto& self = *static_cast<Usbfs*>(usbfs);
    const std::scoped_lock lock(self.device.mutex_);
    return self.on_ioctl(client);
  }
  static void vanished(UMockdevIoctlBase*, UMockdevIoctlClient* client, void* usbfs) {
    auto& self = *static_cast<Usbfs*>(usbfs);
    const std::scoped_lock lock(self.device.mutex_);
    self.on_vanished(client);
  }
  static gboolean tick(void* usbfs) {
    auto& self = *static_cast<Usbfs*>(usbfs);
    const std::scoped_lock lock(self.device.mutex_);
    self.answer_held();
    return G_SOURCE_CONTINUE;
  }

  EmulatedLeap& device;
  UMockdevTestbed* testbed = umockdev_testbed_new();
  UMockdevIoctlBase* ioctls = umockdev_ioctl_base_new();
  GlibLoop loop;
  GSource* timer = g_timeout_source_new(1);
  std::deque<Urb> waiting, silent, done;  ///< for images, for a control without answer, to be taken
  std::vector<UMockdevIoctlClient*> held;  ///< owned: they ask for a transfer that is done
  bool is_halted = false, is_gone = false, is_held = false;
  Counts counts;
};

EmulatedLeap::Usbfs::Usbfs(EmulatedLeap& owner) : device(owner) {
  g_signal_connect(ioctls, "handle-ioctl", G_CALLBACK(ioctl_of), this);
  g_signal_connect(ioctls, "client-vanished", G_CALLBACK(vanished), this);
  g_source_set_callback(timer, tick, this, nullptr);
  g_source_attach(timer, loop.context());
  GError* error = nullptr;
  bool is_made = false;
  loop.with([&] { is_made = umockdev_testbed_attach_ioctl(testbed, kNode, ioctls, &error); });
  if (!is_made) throw std::runtime_error(error->message);
  add();
  loop.start();
}

EmulatedLeap::Usbfs::~Usbfs() {
  loop.stop();
  for (auto* urbs : {&waiting, &silent, &done})
    for (const auto& urb : *urbs) umockdev_ioctl_data_unref(urb.data);
  umockdev_testbed_detach_ioctl(testbed, kNode, nullptr);
  g_source_destroy(timer);
  g_source_unref(timer);
  g_object_unref(ioctls);
  g_object_unref(testbed);
}

void EmulatedLeap::Usbfs::add() const {
  GError* error = nullptr;
  const auto text = description_of(device.model_.configuration());
  if (!umockdev_testbed_add_from_string(testbed, text.c_str(), &error))
    throw std::runtime_error(error->message);
}

void EmulatedLeap::Usbfs::remove() const {
  const auto path = std::string("/sys") + kPath;
  umockdev_testbed_uevent(testbed, path.c_str(), "remove");
  umockdev_testbed_remove_device(testbed, path.c_str());
}

gboolean EmulatedLeap::Usbfs::on_ioctl(UMockdevIoctlClient* client) {
  auto* argument = umockdev_ioctl_client_get_arg(client);
  const auto request = umockdev_ioctl_client_get_request(client);
  int error = 0;
  if (request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY) return reap(client), TRUE;
  if (is_gone) {
    error = ENODEV;
  } else if (request == USBDEVFS_SUBMITURB) {
    submit(client, argument);
  } else if (request == USBDEVFS_DISCARDURB) {
    return discard(client, argument), TRUE;
  } else if (request == USBDEVFS_GET_CAPABILITIES) {
    auto* data = umockdev_ioctl_data_resolve(argument, 0, 4, nullptr);
    std::uint32_t what = USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                         USBDEVFS_CAP_REAP_AFTER_DISCONNECT | USBDEVFS_CAP_ZERO_PACKET;
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &what, 4);
    umockdev_ioctl_data_update(data, 0, bytes.data(), 4);
    umockdev_ioctl_data_unref(data);
  } else if (request == USBDEVFS_DISCONNECT_CLAIM || request == USBDEVFS_CLAIMINTERFACE) {
    if (is_held) error = EBUSY;
    counts.detached += !is_held && request == USBDEVFS_DISCONNECT_CLAIM;
  } else if (request == USBDEVFS_CLEAR_HALT) {
    counts.halts_cleared += is_halted;
    is_halted = false;
  } else if (request == USBDEVFS_RESET) {
    ++counts.resets;
    device.model_.stop();
  } else if (request == USBDEVFS_GETDRIVER) {
    error = ENODATA;
  } else if (request != USBDEVFS_RELEASEINTERFACE && request != USBDEVFS_IOCTL &&
             request != USBDEVFS_SETINTERFACE && request != USBDEVFS_SETCONFIGURATION) {
    ++counts.unknown;
    error = ENOTTY;
  }
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
  return TRUE;
}

void EmulatedLeap::Usbfs::submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
  auto* data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
  const Urb urb{client, data};
  if (urb.urb().buffer_length > 0) {
    auto* buffer = umockdev_ioctl_data_resolve(
        data, offsetof(usbdevfs_urb, buffer), static_cast<gsize>(urb.urb().buffer_length), nullptr);
    umockdev_ioctl_data_unref(buffer);
  }
  if (urb.urb().type == USBDEVFS_URB_TYPE_CONTROL) return answer_control(urb);
  waiting.push_back(urb);
  counts.most_waiting = std::max(counts.most_waiting, static_cast<int>(waiting.size()));
}

void EmulatedLeap::Usbfs::answer_control(Urb urb) {
  const auto bytes = urb.buffer();
  const bool reads = (bytes[0] & 0x80) != 0;
  const auto data = bytes.subspan(kSetupBytes);
  const auto answer =
      device.model_.control(bytes.first<kSetupBytes>(), reads ? data.first(0) : data);
  if (!answer) return finish(urb, -EPIPE, 0);
  const auto count = std::min(answer->size(), data.size());
  std::copy_n(answer->begin(), count, data.begin());
  finish(urb, 0, reads ? count : data.size());
}

void EmulatedLeap::Usbfs::finish(Urb urb, int status, std::size_t bytes) {
  urb.urb().status = status;
  urb.urb().actual_length = static_cast<int>(bytes);
  done.push_back(urb);
}

void EmulatedLeap::Usbfs::discard(UMockdevIoctlClient* client, const UMockdevIoctlData* argument) {
  gulong wanted = 0;
  std::memcpy(&wanted, argument->data, sizeof wanted);
  const auto is_wanted = [&](const Urb& urb) {
    return urb.data->client_addr == wanted || urb.data->client_addr == argument->client_addr;
  };
  for (auto* urbs : {&waiting, &silent})
    if (const auto found = std::ranges::find_if(*urbs, is_wanted); found != urbs->end()) {
      finish(*found, -ENOENT, 0);
      urbs->erase(found);
      return umockdev_ioctl_client_complete(client, 0, 0);
    }
  umockdev_ioctl_client_complete(client, -1, EINVAL);
}

/// The payloads that are due, into the transfers that wait.
void EmulatedLeap::Usbfs::pump() {
  const auto time_ns = now_ns();
  while (!waiting.empty() && !is_halted) {
    const auto delivery = device.model_.next(time_ns);
    if (!delivery) break;
    const auto urb = waiting.front();
    waiting.pop_front();
    if (delivery->fault == LeapFault::stall) {
      is_halted = true;
      finish(urb, -EPIPE, 0);
    } else if (delivery->fault == LeapFault::transfer_error) {
      finish(urb, -EPROTO, 0);
    } else {
      const auto count = std::min(delivery->bytes.size(), urb.buffer().size());
      std::copy_n(delivery->bytes.begin(), count, urb.buffer().begin());
      finish(urb, 0, count);
    }
  }
  if (waiting.empty() || is_halted) device.model_.overflow(time_ns);
}

bool EmulatedLeap::Usbfs::reap_now(UMockdevIoctlClient* client) {
  const auto own = std::ranges::find(done, client, &Urb::client);
  if (own == done.end()) return false;
  auto* data = own->data;
  done.erase(own);
  auto* pointer = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0,
                                              sizeof(gpointer), nullptr);
  if (pointer) {  // null: its process has ended
    umockdev_ioctl_data_set_ptr(pointer, 0, data);
    umockdev_ioctl_data_unref(pointer);
  }
  umockdev_ioctl_client_complete(client, pointer ? 0 : -1, pointer ? 0 : EFAULT);
  umockdev_ioctl_data_unref(data);
  return true;
}

/// The descriptor is always readable, so the answer that nothing is done takes up to 1 ms.
void EmulatedLeap::Usbfs::reap(UMockdevIoctlClient* client) {
  if (done.empty()) pump();
  if (reap_now(client)) return;
  if (is_gone) return umockdev_ioctl_client_complete(client, -1, ENODEV);
  held.push_back(UMOCKDEV_IOCTL_CLIENT(g_object_ref(client)));
}

void EmulatedLeap::Usbfs::answer_held() {
  pump();
  for (auto* client : std::exchange(held, {})) {
    if (!reap_now(client)) umockdev_ioctl_client_complete(client, -1, is_gone ? ENODEV : EAGAIN);
    g_object_unref(client);
  }
}

void EmulatedLeap::Usbfs::on_vanished(const UMockdevIoctlClient* client) {
  for (auto* urbs : {&waiting, &silent, &done})
    std::erase_if(*urbs, [&](const Urb& urb) {
      if (urb.client == client) umockdev_ioctl_data_unref(urb.data);
      return urb.client == client;
    });
}

void EmulatedLeap::Usbfs::disconnect() {
  is_gone = true;
  device.model_.stop();
  for (auto* urbs : {&waiting, &silent})
    for (const auto& urb : std::exchange(*urbs, {})) finish(urb, -ESHUTDOWN, 0);
}

EmulatedLeap::EmulatedLeap(const std::function<void(LeapModel&)>& change) {
  if (change) change(model_);
  usbfs_ = std::make_unique<Usbfs>(*this);
}

EmulatedLeap::~EmulatedLeap() {
  if (!with_model([this](const LeapModel&) { return usbfs_->is_gone; })) unplug();
}

void EmulatedLeap::unplug() {
  {
    const std::scoped_lock lock(mutex_);
    usbfs_->disconnect();
  }
  usbfs_->remove();
}

void EmulatedLeap::plug_in() {
  {
    const std::scoped_lock lock(mutex_);
    usbfs_->is_gone = usbfs_->is_halted = false;
  }
  usbfs_->add();
}

void EmulatedLeap::hold(bool is_held) {
  const std::scoped_lock lock(mutex_);
  usbfs_->is_held = is_held;
}

EmulatedLeap::Counts EmulatedLeap::counts() const {
  const std::scoped_lock lock(mutex_);
  return usbfs_->counts;
}

}  // namespace handcast::test
