// SPDX-License-Identifier: Apache-2.0
#include "services/camera/film_pictures.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/input_file.hpp"
#include "services/camera/film_reader.hpp"

namespace handcast::camera {
namespace fs = std::filesystem;
namespace {

constexpr double kFastest_hz = 100'000;

/// The functions of the library, which stays loaded.
struct Library {
  decltype(&handcast_film_open) open = nullptr;
  decltype(&handcast_film_read) read = nullptr;
  decltype(&handcast_film_close) close = nullptr;
};

Result<Library> load_library() {
  const auto file = fs::read_symlink("/proc/self/exe").parent_path().parent_path() /
                    "lib/handcast/libhandcast-film.so";
  void* loaded = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!loaded) return fail(Errc::bad_config, fmt::format("films cannot be read: {}", ::dlerror()));
  const Library library{
      reinterpret_cast<decltype(Library::open)>(::dlsym(loaded, "handcast_film_open")),
      reinterpret_cast<decltype(Library::read)>(::dlsym(loaded, "handcast_film_read")),
      reinterpret_cast<decltype(Library::close)>(::dlsym(loaded, "handcast_film_close"))};
  if (!library.open || !library.read || !library.close)
    return fail(Errc::bad_config, fmt::format("{} is of another version", file.string()));
  return library;
}

using Film = std::unique_ptr<handcast_film, decltype(&handcast_film_close)>;

class FilmPictures final : public PictureSource {
 public:
  FilmPictures(Library library, Film film, std::int64_t exposure_ns)
      : library_(library), film_(std::move(film)), exposure_ns_(exposure_ns) {}
  Result<void> read(std::size_t index, msg::CameraFrame& frame,
                    std::span<std::uint8_t> pixels) override {
    frame = {};
    frame.exposure_ns = exposure_ns_;
    if (library_.read(film_.get(), static_cast<long>(index), pixels.data()) != 0) return {};
    return fail(Errc::bad_data, fmt::format("frame {} of the film cannot be read", index));
  }

 private:
  Library library_;
  Film film_;
  std::int64_t exposure_ns_;
};

Result<void> check(const fs::path& file, const handcast_film_about& about, const PlayedAs& as) {
  if (about.width_px != as.width_px || about.height_px != as.height_px)
    return fail(Errc::bad_config, fmt::format("'{}' is {} x {} px, but the calibration is for a "
                                              "camera of {} x {} px",
                                              file.string(), about.width_px, about.height_px,
                                              as.width_px, as.height_px));
  if (about.frames < 1 || about.frames > 20'000'000)
    return fail(Errc::bad_config,
                fmt::format("'{}' does not say how many frames it has; convert it "
                            "to AVI or MP4",
                            file.string()));
  return {};
}

}  // namespace

Result<PlayedPictures> open_film_pictures(const fs::path& file, const PlayedAs& as) {
  if (const auto fd = open_input(file, std::numeric_limits<std::int64_t>::max()); !fd)
    return tl::make_unexpected(fd.error());
  const auto library = load_library();
  if (!library) return tl::make_unexpected(library.error());
  handcast_film_about about{};
  Film film(library->open(file.c_str(), &about), library->close);
  if (!film)
    return fail(Errc::bad_config,
                fmt::format("'{}' is no film that OpenCV can read", file.string()));
  if (auto fine = check(file, about, as); !fine) return tl::make_unexpected(fine.error());
  const bool says_rate =
      std::isfinite(about.rate_hz) && about.rate_hz > 0 && about.rate_hz < kFastest_hz;
  const double rate_hz = says_rate ? about.rate_hz : as.rate_hz;
  std::vector<std::int64_t> times_ns;
  for (long i = 0; i < about.frames; ++i)
    times_ns.push_back(seconds_to_ns(static_cast<double>(i) / rate_hz));
  auto loop =
      timing::Loop::make(std::move(times_ns), {}, as.epoch_ns, as.loop, seconds_to_ns(1 / rate_hz));
  if (!loop) return fail_in(file.string(), loop.error());
  return PlayedPictures{
      std::make_unique<FilmPictures>(*library, std::move(film), as.exposure_ns),
      recording::Schedule(std::move(*loop), static_cast<std::size_t>(about.frames))};
}

}  // namespace handcast::camera
