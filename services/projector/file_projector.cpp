// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/daemon/contract.hpp"
#include "services/projector/light_clock.hpp"
#include "services/projector/picture_writer.hpp"

namespace handcast::projector {
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
  const fs::path folder = daemon::out_folder().value_or(".") / "light";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return fail(Errc::bad_config, fmt::format("projector 'file': '{}' cannot be created: {}",
                                              folder.string(), error.message()));
  log::info("the first of {} frames is written to '{}'", rig.projector.file.every, folder.string());
  return std::make_unique<FileProjector>(rig.projector, folder);
}

}  // namespace handcast::projector
