// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"
#include "renderer/media/film_reader.hpp"
#include "services/camera/played_pictures.hpp"

namespace handcast::camera {
namespace {

using renderer::FilmReader;

class FilmPictures final : public PictureSource {
 public:
  FilmPictures(std::unique_ptr<FilmReader> film, std::int64_t exposure_ns)
      : film_(std::move(film)), exposure_ns_(exposure_ns) {}
  Result<void> read(std::size_t index, msg::CameraFrame& frame,
                    std::span<std::uint8_t> pixels) override {
    frame = {};
    frame.exposure_ns = exposure_ns_;
    if (film_->read(static_cast<std::int64_t>(index), pixels.data())) return {};
    return fail(Errc::bad_data, fmt::format("frame {} of the film cannot be read", index));
  }

 private:
  std::unique_ptr<FilmReader> film_;
  std::int64_t exposure_ns_;
};

Result<void> check(const std::filesystem::path& file, const FilmReader& film, const PlayedAs& as) {
  if (film.width_px() != as.width_px || film.height_px() != as.height_px)
    return fail(Errc::bad_config, fmt::format("'{}' is {} x {} px, but the calibration is for a "
                                              "camera of {} x {} px",
                                              file.string(), film.width_px(), film.height_px(),
                                              as.width_px, as.height_px));
  if (film.times_ns().empty())
    return fail(Errc::bad_config,
                fmt::format("'{}' does not say the times of its frames; convert it to AVI or MP4",
                            file.string()));
  return {};
}

}  // namespace

Result<PlayedPictures> open_film_pictures(const std::filesystem::path& file, const PlayedAs& as) {
  auto film = renderer::open_film(file);
  if (!film) return tl::make_unexpected(film.error());
  if (auto fine = check(file, **film, as); !fine) return tl::make_unexpected(fine.error());
  const auto count = (*film)->times_ns().size();
  auto loop = timing::Loop::make((*film)->times_ns(), {}, as.epoch_ns, as.loop,
                                 seconds_to_ns(1 / as.rate_hz));
  if (!loop) return fail_in(file.string(), loop.error());
  return PlayedPictures{std::make_unique<FilmPictures>(std::move(*film), as.exposure_ns),
                        recording::Schedule(std::move(*loop), count)};
}

}  // namespace handcast::camera
