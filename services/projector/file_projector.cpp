// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/daemon/contract.hpp"
#include "renderer/media/film.hpp"
#include "renderer/media/jpeg.hpp"
#include "renderer/media/picture.hpp"
#include "renderer/output/light.hpp"
#include "renderer/pipeline/frame.hpp"
#include "services/projector/light_clock.hpp"

namespace handcast::projector {

/// Writes the light of frames to files on a thread of its own, as PNG pictures or as a film. If
/// frames come faster than that, only the newest one waits; so the last one is never left out. One
/// thread calls it.
class PictureWriter {
 public:
  /// Writes to light_000.png … light_099.png in the folder, then from the first again, or to
  /// light.avi: light-2.avi if there is one, and so on.
  PictureWriter(std::filesystem::path folder, bool is_film);
  /// Waits until the last frame is written.
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  /// Has the whole projector image written, dark outside the region of the frame, and returns at
  /// once. Errors: unavailable, bad_config (a frame before could not be written).
  Result<void> write(const renderer::Frame& frame, const renderer::LightTable& light,
                     std::int64_t time_ns);

 private:
  /// A projector image, and when it is lit.
  struct Picture {
    renderer::Texture light;
    renderer::Rect lit;  ///< the part of it that may not be dark
    std::int64_t time_ns = 0;
  };

  void work();
  Result<void> write_picture();
  Result<void> write_to_film();
  Result<void> begin_film();

  std::filesystem::path folder_;
  bool is_film_;
  std::uint64_t written_ = 0, left_out_ = 0;

  std::mutex mutex_;  ///< for what follows
  std::condition_variable changed_;
  bool is_waiting_ = false, is_ending_ = false;
  Picture waiting_;      ///< if is_waiting_, what is to be written next
  Result<void> failed_;  ///< why a frame since the last call could not be written
  // The thread's own.
  Picture written_now_;
  std::uint64_t number_ = 0;  ///< of the next picture
  std::optional<renderer::Film> film_;

  std::thread thread_;
};

namespace {

constexpr std::uint64_t kKept = 100;  ///< number of pictures, then the oldest is overwritten

/// The first of light.avi, light-2.avi, light-3.avi … that does not exist. What cannot be looked at
/// cannot be written either, which says why.
std::filesystem::path new_film_in(const std::filesystem::path& folder) {
  auto file = folder / "light.avi";
  std::error_code unknown;
  for (int number = 2; std::filesystem::exists(file, unknown); ++number)
    file = folder / fmt::format("light-{}.avi", number);
  return file;
}

}  // namespace

PictureWriter::PictureWriter(std::filesystem::path folder, bool is_film)
    : folder_(std::move(folder)), is_film_(is_film), thread_([this] { work(); }) {}

PictureWriter::~PictureWriter() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (written_ + left_out_ > 0)
    log::info("{} frames are in '{}', {} were left out", written_, folder_.string(), left_out_);
}

Result<void> PictureWriter::write(const renderer::Frame& frame, const renderer::LightTable& light,
                                  std::int64_t time_ns) {
  const std::lock_guard lock(mutex_);
  if (is_waiting_ && left_out_++ == 0)
    log::warning(
        "frames come faster than they can be written to '{}' and are left out; a larger "
        "projector.file.every leaves out none",
        folder_.string());
  auto& [picture, lit, display_ns] = waiting_;
  if (picture.width() != frame.colour.width || picture.height() != frame.colour.height) {
    picture = renderer::Texture(frame.colour.width, frame.colour.height);
    lit = {};
  }
  for (int y = lit.y0; y < lit.y1; ++y) std::fill_n(picture.row(y) + lit.x0, lit.width(), 0);
  lit = frame.region.within(picture.width(), picture.height());
  renderer::write_light(frame.colour, lit, light, picture.view());
  display_ns = time_ns;
  is_waiting_ = true;
  changed_.notify_all();
  return std::exchange(failed_, {});
}

void PictureWriter::work() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);  // the daemon may be real-time
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return is_waiting_ || is_ending_; });
    if (!is_waiting_) return;
    std::swap(waiting_, written_now_);
    is_waiting_ = false;
    lock.unlock();
    auto written = is_film_ ? write_to_film() : write_picture();
    lock.lock();
    if (written)
      ++written_;
    else
      failed_ = std::move(written);
  }
}

Result<void> PictureWriter::write_picture() {
  return renderer::write_png(folder_ / fmt::format("light_{:03}.png", number_++ % kKept),
                             written_now_.light.view());
}

Result<void> PictureWriter::begin_film() {
  auto film = renderer::Film::create(new_film_in(folder_), written_now_.light.width(),
                                     written_now_.light.height());
  if (!film) return tl::make_unexpected(film.error());
  film_.emplace(std::move(*film));
  return {};
}

Result<void> PictureWriter::write_to_film() {
  const auto jpeg = renderer::jpeg_of(written_now_.light.view());
  if (film_ && !film_->has_room_for(jpeg.size())) film_.reset();
  if (!film_)
    if (auto begun = begin_film(); !begun) return begun;
  return film_->add(jpeg, written_now_.time_ns);
}

namespace fs = std::filesystem;
namespace {

constexpr auto kClaim = std::chrono::seconds(1);  ///< longest wait for the folder

/// Writes the light to files, to see it without hardware: in light/ of the folder for kept files,
/// or of the current folder if there is none.
class FileProjector final : public Projector {
 public:
  FileProjector(const config::Projector& settings, fs::path folder)
      : clock_(settings),
        every_(settings.file.every),
        folder_(std::move(folder)),
        writer_(folder_, settings.file.film) {}

  Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t frame_id,
                               const renderer::LightTable& light, Deadline deadline) override {
    if (auto claimed = claim(); !claimed) return tl::make_unexpected(claimed.error());
    auto times = clock_.take(deadline);
    if (!times || frame_id % every_ != 0) return times;
    if (const auto written = writer_.write(frame, light, times->display_ns); !written)
      return fail(Errc::bad_data, "projector 'file': " + written.error().what);
    return times;
  }

 private:
  /// Locks the folder, so that two rigs cannot write into it. The projector that this one follows
  /// may still hold it for a moment.
  Result<void> claim() {
    if (lock_) return {};
    UniqueFd folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!folder)
      return fail(Errc::unavailable, fmt::format("projector 'file': '{}' cannot be opened: {}",
                                                 folder_.string(), std::strerror(errno)));
    for (const auto limit = Deadline::in(kClaim); flock(folder.get(), LOCK_EX | LOCK_NB) != 0;) {
      if (errno != EWOULDBLOCK) {
        log::warning("projector 'file': '{}' cannot be locked: {}", folder_.string(),
                     std::strerror(errno));
        break;
      }
      if (limit.passed())
        return fail(
            Errc::unavailable,
            fmt::format("projector 'file': another rig writes to '{}'; use --out or another "
                        "folder",
                        folder_.string()));
      sleep_until_ns(now_ns() + 1'000'000);
    }
    lock_ = std::move(folder);
    return {};
  }

  LightClock clock_;
  std::int64_t every_;
  fs::path folder_;
  UniqueFd lock_;  ///< the locked folder; set by the first present()
  PictureWriter writer_;
};

}  // namespace

Result<std::unique_ptr<Projector>> open_file(const config::Rig& rig, const calib::Calibration&) {
  const fs::path folder = daemon::out_folder().value_or(".") / rig.projector.file.folder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return fail(Errc::bad_config, fmt::format("projector 'file': '{}' cannot be created: {}",
                                              folder.string(), error.message()));
  log::info("the first of {} frames is written to '{}'", rig.projector.file.every, folder.string());
  return std::make_unique<FileProjector>(rig.projector, folder);
}

}  // namespace handcast::projector
