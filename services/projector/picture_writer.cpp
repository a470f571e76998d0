// SPDX-License-Identifier: Apache-2.0
#include "services/projector/picture_writer.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <utility>

#include "ipc/base/log.hpp"
#include "renderer/media/jpeg.hpp"
#include "renderer/media/picture.hpp"

namespace handcast::projector {
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

}  // namespace handcast::projector
