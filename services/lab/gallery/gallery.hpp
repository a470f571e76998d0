// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::gallery {

/// What is asked for.
struct Wanted {
  std::vector<std::string> sources;
  std::string folder = "gallery", motion = "builtin:show", sheet;
  int frames = 24;
  double seconds = 6;
  int width_px = 320;  ///< of a picture
};

/// Contents on the moving hands of the twin, and a page of them. One thread.
class Gallery {
 public:
  /// Makes the folder. Errors: bad_config (the motion, the folder).
  static Result<Gallery> open(const Wanted& wanted);
  Gallery(Gallery&&) noexcept;
  ~Gallery();

  /// Shows a content on both hands and writes its pictures, side by side: a filter over the look
  /// tiger, a transition between X-ray and lava. Returns what a picture
  /// takes, ms (median). Errors: those of the content, bad_config (no file can be written).
  Result<double> show(const std::string& content);
  /// Writes index.html. Returns its path. Errors: bad_config.
  Result<std::filesystem::path> write_page() const;
  /// Writes a PNG file with one picture of each content that was shown, the brightest of the later
  /// ones. Errors: bad_config.
  Result<void> write_sheet(const std::filesystem::path& file) const;

 private:
  struct Parts;
  explicit Gallery(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace handcast::gallery
