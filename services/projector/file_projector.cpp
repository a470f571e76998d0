// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <future>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/daemon/contract.hpp"
#include "renderer/content/picture.hpp"
#include "services/projector/light_clock.hpp"

namespace handcast::projector {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kEvery = 100;              ///< every kEvery-th frame is written
constexpr auto kClaim = std::chrono::seconds(1);  ///< longest wait for the folder
constexpr std::int64_t kKept = 100;  ///< number of files, then the oldest is overwritten

/// Writes the light as images, to see it without hardware: PNG files in light/ of the folder for
/// kept files, or of the current folder if there is none.
class FileProjector final : public Projector {
 public:
  FileProjector(const config::Projector& settings, fs::path folder)
      : clock_(settings), folder_(std::move(folder)) {}

  Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t frame_id,
                               const renderer::LightTable& light, Deadline deadline) override {
    if (auto claimed = claim(); !claimed) return tl::make_unexpected(claimed.error());
    auto times = clock_.take(deadline);
    if (!times || frame_id % kEvery != 0) return times;
    if (const auto written = last_written(); !written)
      return fail(Errc::bad_data, "projector 'file': " + written.error().what);
    write(frame, light, folder_ / fmt::format("light_{:03}.png", frame_id / kEvery % kKept));
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

  /// Begins to write the whole projector image, dark outside the region of the frame. The light
  /// does not wait for the encoder, which takes longer than a frame.
  void write(const renderer::Frame& frame, const renderer::LightTable& light,
             const fs::path& file) {
    renderer::Texture image(frame.colour.width, frame.colour.height);
    renderer::write_light(frame.colour, frame.region, light, image.view());
    written_ = std::async(std::launch::async, [image = std::move(image), file] {
      const sched_param none{};
      pthread_setschedparam(pthread_self(), SCHED_BATCH, &none);  // the daemon may be real-time
      return renderer::write_png(file, image.view());
    });
  }

  /// Waits for the last picture, and returns whether it was written.
  Result<void> last_written() { return written_.valid() ? written_.get() : Result<void>(); }

  LightClock clock_;
  fs::path folder_;
  UniqueFd lock_;  ///< the locked folder; set by the first present()
  std::future<Result<void>> written_;
};

}  // namespace

Result<std::unique_ptr<Projector>> open_file(const config::Rig& rig, const calib::Calibration&) {
  const fs::path folder = daemon::out_folder().value_or(".") / "light";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return fail(Errc::bad_config, fmt::format("projector 'file': '{}' cannot be created: {}",
                                              folder.string(), error.message()));
  log::info("every {}th frame is written to '{}'", kEvery, folder.string());
  return std::make_unique<FileProjector>(rig.projector, folder);
}

}  // namespace handcast::projector
