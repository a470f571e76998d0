// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>

#include <atomic>
#include <mutex>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/leap/session.hpp"
#include "services/camera/leap/usb_handle.hpp"

namespace handcast::camera::leap {
namespace {

/// 14 ms of images of 640x240 at 115 Hz.
constexpr std::size_t kTransfers = 32;
/// The stream has ended after this many failed transfers in a row.
constexpr int kMostFailures = 50;
/// From this number on, there is a pause before the next try.
constexpr int kFailuresAtOnce = 4;
constexpr std::int64_t kPause_ns = 2'000'000, kReturn_ns = 1'000'000'000;
constexpr std::int64_t kNothingDone_ns = 200'000;
/// Endpoints of USB 2 deliver in packets of this size; a transfer is a multiple of it.
constexpr std::size_t kPacketBytes = 512;

void make_realtime(int priority) {
  pthread_setname_np(pthread_self(), "camera-stream");
  const sched_param parameters{.sched_priority = priority > 0 ? priority : 1};
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) != 0 && priority > 0)
    log::warning("the thread that receives the images has no real-time priority");
}

}  // namespace

/// Everything of a stream. Only `ends` and `trouble` are shared between threads.
struct UsbStream::State {
  /// A transfer and its memory.
  struct Slot {
    State* state = nullptr;
    libusb_transfer* transfer = nullptr;
    std::vector<std::uint8_t> bytes;
    bool is_waiting = false;  ///< in the kernel
  };

  State(std::shared_ptr<UsbHandle> opened, PayloadSink& to, std::size_t payload_bytes);
  ~State();
  State(const State&) = delete;

  void run(int priority);
  void handle_events();
  /// Cancels what waits and collects it. False if the kernel keeps some.
  bool collect();
  void submit(Slot& slot);
  void submit_idle();
  void on_done(Slot& slot);
  void end(Error why);
  static void LIBUSB_CALL on_transfer(libusb_transfer* transfer) {
    auto& slot = *static_cast<Slot*>(transfer->user_data);
    slot.state->on_done(slot);
  }

  std::shared_ptr<UsbHandle> handle;
  PayloadSink* sink;
  std::vector<Slot> slots;
  std::size_t waiting = 0;
  std::uint64_t returned = 0;  ///< transfers, since the beginning
  int failures = 0;            ///< in a row
  bool is_halted = false;
  bool has_ended = false;
  std::atomic<bool> ends = false;
  mutable std::mutex mutex;
  std::optional<Error> trouble;
};

UsbStream::State::State(std::shared_ptr<UsbHandle> opened, PayloadSink& to,
                        std::size_t payload_bytes)
    : handle(std::move(opened)), sink(&to), slots(kTransfers) {
  const std::size_t bytes = (payload_bytes + kPacketBytes - 1) / kPacketBytes * kPacketBytes;
  for (auto& slot : slots) {
    slot.state = this;
    slot.bytes.resize(bytes);
    slot.transfer = libusb_alloc_transfer(0);
    libusb_fill_bulk_transfer(slot.transfer, handle->device, kImageEndpoint, slot.bytes.data(),
                              static_cast<int>(bytes), on_transfer, &slot, 0);
  }
}

UsbStream::State::~State() {
  for (auto& slot : slots) libusb_free_transfer(slot.transfer);
}

void UsbStream::State::end(Error why) {
  has_ended = true;
  const std::scoped_lock lock(mutex);
  if (!trouble) trouble = std::move(why);
}

void UsbStream::State::submit(Slot& slot) {
  const int code = libusb_submit_transfer(slot.transfer);
  if (code != 0) return end(usb_error(code, *handle, "reading images"));
  slot.is_waiting = true;
  ++waiting;
}

void UsbStream::State::on_done(Slot& slot) {
  const std::int64_t arrived_ns = now_ns();
  slot.is_waiting = false;
  --waiting;
  ++returned;
  switch (slot.transfer->status) {
    case LIBUSB_TRANSFER_COMPLETED:
      failures = 0;
      if (slot.transfer->actual_length > 0)
        sink->on_payload(
            std::span(slot.bytes).first(static_cast<std::size_t>(slot.transfer->actual_length)),
            arrived_ns);
      if (!ends && !has_ended && !is_halted) submit(slot);
      return;
    case LIBUSB_TRANSFER_CANCELLED:
      return;
    case LIBUSB_TRANSFER_NO_DEVICE:
      sink->on_lost_payload();
      return end(usb_error(LIBUSB_ERROR_NO_DEVICE, *handle, ""));
    case LIBUSB_TRANSFER_STALL:
      is_halted = true;
      break;
    default:
      break;
  }
  sink->on_lost_payload();
  if (++failures == kMostFailures)
    end({Errc::unavailable,
         fmt::format("the controller at USB port {}: {} transfers in a row failed", handle->port,
                     kMostFailures)});
}

/// Those that failed begin again outside of their callbacks, where calls may block.
void UsbStream::State::submit_idle() {
  if (waiting == slots.size()) return;
  if (failures > kFailuresAtOnce) sleep_until_ns(now_ns() + kPause_ns);
  if (is_halted) {
    const int code = libusb_clear_halt(handle->device, kImageEndpoint);
    if (code != 0) return end(usb_error(code, *handle, "ending a halt"));
    is_halted = false;
  }
  for (auto& slot : slots)
    if (!slot.is_waiting && !has_ended) submit(slot);
}

/// A kernel that says again and again that something is done, and nothing is, must not keep a
/// real-time thread busy.
void UsbStream::State::handle_events() {
  timeval most{.tv_sec = 0, .tv_usec = 50'000};
  const auto before = returned;
  libusb_handle_events_timeout_completed(handle->context, &most, nullptr);
  if (returned == before) sleep_until_ns(now_ns() + kNothingDone_ns);
}

bool UsbStream::State::collect() {
  for (auto& slot : slots)
    if (slot.is_waiting) libusb_cancel_transfer(slot.transfer);
  for (const auto until = Deadline::in(std::chrono::nanoseconds(kReturn_ns));
       waiting > 0 && !until.passed();)
    handle_events();
  return waiting == 0;
}

void UsbStream::State::run(int priority) {
  make_realtime(priority);
  while (!ends && !has_ended) {
    submit_idle();
    handle_events();
  }
}

Result<std::unique_ptr<UsbStream>> UsbStream::start(const UsbDevice& device, PayloadSink& sink,
                                                    std::size_t payload_bytes, int priority) {
  const auto state = std::make_shared<State>(device.handle(), sink, payload_bytes);
  std::unique_ptr<UsbStream> stream(new UsbStream(state));
  // The thread takes no signals: those of the daemon are for its main thread.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  stream->thread_ = std::thread([state, priority] {
    state->run(priority);
    // The kernel may still write into the memory of transfers that it keeps.
    if (!state->collect()) new std::shared_ptr<State>(state);
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return stream;
}

UsbStream::UsbStream(std::shared_ptr<State> state) : state_(std::move(state)) {}

UsbStream::~UsbStream() {
  state_->ends = true;
  libusb_interrupt_event_handler(state_->handle->context);
  if (thread_.joinable()) thread_.join();
}

std::optional<Error> UsbStream::trouble() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->trouble;
}

}  // namespace handcast::camera::leap
