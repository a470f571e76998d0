// SPDX-License-Identifier: Apache-2.0
#include "services/projector/dlp/hid_device.hpp"

#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <mutex>

namespace handcast::dlp {
namespace {

/// A read ends by itself at its deadline; this is the time that its thread may take to say so.
constexpr std::int64_t kGrace_ns = 500'000'000;
/// The time that a call gets whose deadline has passed: what can be done at once is done.
constexpr std::int64_t kLeast_ns = 20'000'000;

std::string narrow(const wchar_t* text) {
  std::string narrowed;
  for (; text && *text; ++text)
    narrowed += *text > 31 && *text < 127 ? static_cast<char>(*text) : '?';
  return narrowed;
}

std::chrono::steady_clock::time_point time_of(std::int64_t time_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns));
}

/// Rounded up, so that a read does not end before its deadline.
int ms_until(Deadline deadline) {
  const auto left_ns = deadline.time_ns() - now_ns();
  return left_ns <= 0 ? 0 : static_cast<int>((left_ns + 999'999) / 1'000'000);
}

Error why_not_open(const HidInfo& info) {
  if (access(info.path.c_str(), R_OK | W_OK) != 0 && errno == EACCES)
    return {
        Errc::unavailable,
        fmt::format("{}: access is denied; `scripts/setup --udev` installs the rule that permits "
                    "it, then connect the device again",
                    info.path)};
  return {Errc::unavailable,
          fmt::format("{} cannot be opened: {}", info.path, narrow(hid_error(nullptr)))};
}

}  // namespace

/// What the caller and the thread share. All members but `handle` are guarded by `mutex`.
struct HidDevice::Port {
  enum Job { kNothing, kWrite, kRead, kClose };

  explicit Port(hid_device* opened) : handle(opened) {}
  ~Port() { hid_close(handle); }
  Port(const Port&) = delete;

  void run();
  int call(Job todo, protocol::Report& bytes, Deadline until) const;

  hid_device* const handle;
  std::mutex mutex;
  std::condition_variable changed;
  Job job = kNothing;
  Deadline deadline = Deadline::now();
  protocol::Report report{};
  int result = 0;  ///< of the last job: number of bytes, or -1
};

int HidDevice::Port::call(Job todo, protocol::Report& bytes, Deadline until) const {
  if (todo == kRead) return hid_read_timeout(handle, bytes.data(), bytes.size(), ms_until(until));
  std::array<std::uint8_t, 1 + protocol::kReportBytes> numbered{};  // number 0: it has none
  std::ranges::copy(bytes, numbered.begin() + 1);
  return hid_write(handle, numbered.data(), numbered.size());
}

void HidDevice::Port::run() {
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [this] { return job != kNothing; });
    if (job == kClose) return;
    auto bytes = report;
    const auto todo = job;
    const auto until = deadline;
    lock.unlock();
    const int done = call(todo, bytes, until);
    lock.lock();
    result = done;
    report = bytes;
    if (job != kClose) job = kNothing;
    changed.notify_all();
  }
}

std::vector<HidInfo> list_hid_devices(std::uint16_t vendor_id) {
  std::vector<HidInfo> devices;
  auto* list = hid_enumerate(vendor_id, 0);
  for (const auto* entry = list; entry; entry = entry->next)
    if (entry->interface_number <= 0)
      devices.push_back({.path = entry->path,
                         .serial = narrow(entry->serial_number),
                         .product = narrow(entry->product_string),
                         .product_id = entry->product_id});
  hid_free_enumeration(list);
  return devices;
}

Result<std::unique_ptr<HidDevice>> HidDevice::open(const HidInfo& info) {
  auto* handle = hid_open_path(info.path.c_str());
  if (!handle) return tl::make_unexpected(why_not_open(info));
  return std::unique_ptr<HidDevice>(new HidDevice(std::make_shared<Port>(handle)));
}

// The thread takes no signals: they would interrupt its calls.
HidDevice::HidDevice(std::shared_ptr<Port> port) : port_(std::move(port)) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([shared = port_] { shared->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

HidDevice::~HidDevice() {
  {
    const std::lock_guard lock(port_->mutex);
    port_->job = Port::kClose;
  }
  port_->changed.notify_all();
  if (lost_)
    thread_.detach();
  else
    thread_.join();
}

/// Lets the thread do a job and waits for it. Returns what the library returned.
Result<int> HidDevice::carry_out(int job, protocol::Report& report, Deadline deadline) {
  if (lost_) return fail(Errc::disconnected, "the device has stopped");
  std::unique_lock lock(port_->mutex);
  port_->deadline = deadline;
  port_->report = report;
  port_->job = static_cast<Port::Job>(job);
  port_->changed.notify_all();
  const auto patience_ns =
      std::max(deadline.time_ns() + (job == Port::kRead ? kGrace_ns : 0), now_ns() + kLeast_ns);
  lost_ = !port_->changed.wait_until(lock, time_of(patience_ns),
                                     [this] { return port_->job == Port::kNothing; });
  if (lost_) return fail(Errc::disconnected, "the device takes no commands");
  lost_ = port_->result < 0;
  if (lost_) return fail(Errc::disconnected, "the device has been unplugged");
  report = port_->report;
  return port_->result;
}

Result<void> HidDevice::write(const protocol::Report& report, Deadline deadline) {
  auto copy = report;
  const auto written = carry_out(Port::kWrite, copy, deadline);
  return written ? Result<void>() : tl::make_unexpected(written.error());
}

Result<std::size_t> HidDevice::read(protocol::Report& report, Deadline deadline) {
  const auto count = carry_out(Port::kRead, report, deadline);
  if (!count) return tl::make_unexpected(count.error());
  if (*count == 0) return fail(Errc::timeout, "the device has not answered");
  return static_cast<std::size_t>(*count);
}

}  // namespace handcast::dlp
