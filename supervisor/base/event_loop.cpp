// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/event_loop.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <sys/timerfd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "ipc/base/inherited.hpp"

namespace handcast::supervisor {
namespace {

tl::unexpected<Error> no_descriptor(const char* what) {
  return fail(Errc::unavailable, fmt::format("{}: {}", what, std::strerror(errno)));
}

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!inherited::is_ignored(signal)) sigaddset(&signals, signal);
  return signals;
}

}  // namespace

Result<EventLoop> EventLoop::open() {
  UniqueFd epoll(epoll_create1(EPOLL_CLOEXEC));
  if (!epoll) return no_descriptor("epoll");
  return EventLoop(std::move(epoll));
}

void EventLoop::watch(int fd, std::function<void()> on_readable) {
  epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
  epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event);
  handlers_[fd] = {std::move(on_readable), {}};
}

void EventLoop::watch_writing(int fd, std::function<void()> on_writable) {
  const auto found = handlers_.find(fd);
  if (found == handlers_.end()) return;
  epoll_event event{.events = on_writable ? EPOLLIN | EPOLLOUT : EPOLLIN, .data = {.fd = fd}};
  epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, fd, &event);
  found->second.writable = std::move(on_writable);
}

void EventLoop::forget(int fd) {
  if (handlers_.erase(fd) > 0) epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, fd, nullptr);
}

void EventLoop::turn() {
  std::array<epoll_event, 32> events;
  const int count = epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()), -1);
  for (int i = 0; i < count; ++i) {
    const auto& event = events[static_cast<std::size_t>(i)];
    if (event.events & ~static_cast<std::uint32_t>(EPOLLOUT))
      call(event.data.fd, &Handlers::readable);
    if (event.events & EPOLLOUT) call(event.data.fd, &Handlers::writable);
  }
}

void EventLoop::call(int fd, std::function<void()> Handlers::*which) {
  const auto found = handlers_.find(fd);
  if (found == handlers_.end()) return;
  const auto handler = found->second.*which;  // a copy: it may call forget() for its descriptor
  if (handler) handler();
}

Result<UniqueFd> open_timer(std::int64_t period_ns) {
  UniqueFd timer(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK));
  if (!timer) return no_descriptor("timer");
  const timespec period{period_ns / 1'000'000'000, period_ns % 1'000'000'000};
  const itimerspec times{.it_interval = period, .it_value = period};
  timerfd_settime(timer.get(), 0, &times, nullptr);
  return timer;
}

Result<UniqueFd> open_stop_signals() {
  const auto signals = stop_signals();
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  UniqueFd fd(signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
  if (!fd) return no_descriptor("signals");
  return fd;
}

void drain(int fd) {
  std::array<char, 1024> bytes;
  while (::read(fd, bytes.data(), bytes.size()) > 0) {
  }
}

}  // namespace handcast::supervisor
