// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "renderer/media/colour_film.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {
namespace {

using renderer::FilmOpening;
using renderer::Texture;
using StreamClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kReconnect{2};

/// What the source and the thread that reads its stream share.
struct StreamState {
  FilmOpening opening;
  int width, height;
  std::atomic<bool> is_over = false;
  std::mutex mutex;
  std::condition_variable wake;  ///< when it is over
  Texture newest;
  bool is_new = false;
  std::optional<Error> trouble;  ///< that was not told yet

  /// Returns true if it is over.
  bool wait_until(StreamClock::time_point time) {
    std::unique_lock lock(mutex);
    return wake.wait_until(lock, time, [this] { return is_over.load(); });
  }
  void note(Error error) {
    // The source goes on by itself, and must not be opened again.
    if (error.code != Errc::bad_config) error.code = Errc::timeout;
    const std::lock_guard lock(mutex);
    trouble = std::move(error);
  }
};

/// Shows the frames of a stream until it ends. Those that come faster than they are shown, as
/// from a film behind an address, wait for their time.
Error read_frames(StreamState& state, renderer::ColourFilm& film) {
  constexpr std::chrono::milliseconds kLate{300};
  Texture picture(state.width, state.height);
  std::optional<StreamClock::time_point> begin;
  for (;;) {
    const auto time_ns = film.next();
    if (!time_ns) return time_ns.error();
    if (!*time_ns)
      return {Errc::disconnected, fmt::format("'{}' has ended", state.opening.address)};
    const auto now = StreamClock::now();
    const std::chrono::nanoseconds time(**time_ns);
    if (!begin || *begin + time + kLate < now) begin = now - time;
    if (!film.is_live() && state.wait_until(*begin + time)) return {};
    if (!film.read(picture)) continue;
    const std::lock_guard lock(state.mutex);
    std::swap(picture, state.newest);
    if (picture.width() != state.width) picture = Texture(state.width, state.height);
    state.is_new = true;
  }
}

/// Reads a stream, and connects again every 2 s.
void read_stream(const std::shared_ptr<StreamState>& state) {
  while (!state->is_over) {
    const auto again = StreamClock::now() + kReconnect;
    auto film = renderer::open_colour_film(state->opening, state->is_over);
    Error error = film ? read_frames(*state, **film) : film.error();
    film = {};
    if (state->is_over) return;
    state->note(error);
    if (error.code == Errc::bad_config || state->wait_until(again)) return;
  }
}

/// A stream or a video device, read by a thread of its own. The thread is not waited for: it may
/// be looking up an address, which cannot be interrupted.
class StreamSource final : public SettableSource {
 public:
  StreamSource(FilmOpening opening, int width, int height, std::vector<Parameter> parameters)
      : SettableSource(std::move(parameters)),
        opening_(std::move(opening)),
        width_(width),
        height_(height) {}
  ~StreamSource() override { stop(); }

  Result<bool> draw(const Moment&, std::span<const renderer::View<const std::uint32_t>>,
                    Texture& out) override {
    if (take_change()) start();
    const std::lock_guard lock(state_->mutex);
    if (std::exchange(state_->is_new, false)) {
      std::swap(out, state_->newest);
      return true;
    }
    if (auto trouble = std::exchange(state_->trouble, std::nullopt))
      return tl::make_unexpected(std::move(*trouble));
    return false;
  }

 private:
  void start() {
    stop();
    if (opening_.kind == FilmOpening::Kind::device) {
      opening_.width_px = static_cast<int>(number("width"));
      opening_.height_px = static_cast<int>(number("height"));
      opening_.rate_hz = number("rate");
    }
    state_ = std::make_shared<StreamState>();
    state_->opening = opening_;
    state_->width = width_;
    state_->height = height_;
    std::thread(read_stream, state_).detach();
  }
  void stop() {
    if (!state_) return;
    const std::lock_guard lock(state_->mutex);
    state_->is_over = true;
    state_->wake.notify_all();
  }

  FilmOpening opening_;
  int width_, height_;
  std::shared_ptr<StreamState> state_;  ///< null before the first picture
};

/// Errors: unavailable, bad_config.
Result<void> check_device(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0)
    return fail(errno == ENOENT ? Errc::unavailable : Errc::bad_config,
                fmt::format("'{}': {}; `handcast devices` lists the video devices", path,
                            std::strerror(errno)));
  if (!S_ISCHR(status.st_mode))
    return fail(Errc::bad_config, fmt::format("'{}' is not a video device", path));
  if (::access(path.c_str(), R_OK | W_OK) != 0)
    return fail(Errc::unavailable,
                fmt::format("'{}' may not be opened by this user; add the user to the group "
                            "'video'",
                            path));
  return {};
}

}  // namespace

Result<std::unique_ptr<Source>> open_stream(const Opening& opening) {
  return std::make_unique<StreamSource>(
      FilmOpening{.kind = FilmOpening::Kind::stream, .address = opening.element.what},
      opening.width, opening.height, std::vector<Parameter>{});
}

Result<std::unique_ptr<Source>> open_capture(const Opening& opening) {
  const std::string& path = opening.element.what;
  if (auto fine = check_device(path); !fine) return tl::make_unexpected(fine.error());
  return std::make_unique<StreamSource>(
      FilmOpening{.kind = FilmOpening::Kind::device, .address = path}, opening.width,
      opening.height,
      std::vector{number_parameter("width", "Width in pixels; 0: the device's", 0, 8192, 0),
                  number_parameter("height", "Height in pixels; 0: the device's", 0, 8192, 0),
                  number_parameter("rate", "Frames per second; 0: the device's", 0, 1000, 0)});
}

}  // namespace handcast::content
