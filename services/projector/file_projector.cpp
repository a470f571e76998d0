// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "ipc/base/log.hpp"
#include "ipc/daemon/contract.hpp"
#include "renderer/content/picture.hpp"
#include "services/projector/light_clock.hpp"

namespace handcast::projector {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kEvery = 100;  ///< every kEvery-th frame is written
constexpr std::int64_t kKept = 100;   ///< number of files, then the oldest is overwritten

/// Writes the light as images, to see it without hardware: PNG files in light/ of the folder for
/// kept files, or of the current folder if there is none.
class FileProjector final : public Projector {
 public:
  FileProjector(const config::Projector& settings, fs::path folder)
      : clock_(settings), folder_(std::move(folder)) {}

  Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t frame_id,
                               Deadline deadline) override {
    auto times = clock_.take(deadline);
    if (!times || frame_id % kEvery != 0) return times;
    const fs::path file = folder_ / fmt::format("light_{:03}.png", frame_id / kEvery % kKept);
    if (const auto written = write(frame, file); !written)
      return fail(Errc::bad_data, "projector 'file': " + written.error().what);
    return times;
  }

 private:
  /// Writes the whole projector image, dark outside the region of the frame and where alpha is 0.
  static Result<void> write(const renderer::Frame& frame, const fs::path& file) {
    renderer::Texture image(frame.colour.width, frame.colour.height);
    const auto& region = frame.region;
    for (int y = region.y0; y < region.y1; ++y)
      for (int x = region.x0; x < region.x1; ++x)
        if (const std::uint32_t rgba = frame.colour.at(x, y); rgba >> 24 != 0)
          image.at(x, y) = rgba;
    return renderer::write_png(file, image.view());
  }

  LightClock clock_;
  fs::path folder_;
};

}  // namespace

Result<std::unique_ptr<Projector>> open_file(const config::Rig& rig) {
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
