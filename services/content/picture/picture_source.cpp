// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <system_error>

#include "renderer/media/picture.hpp"
#include "services/content/scaled.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {
namespace {

namespace fs = std::filesystem;

/// The time of the last change of a file; the epoch if there is none.
fs::file_time_type changed_at(const fs::path& file) {
  std::error_code failed;
  const auto time = fs::last_write_time(file, failed);
  return failed ? fs::file_time_type{} : time;
}

class PictureSource final : public SettableSource {
 public:
  PictureSource(fs::path file, fs::file_time_type changed, renderer::Texture picture)
      : SettableSource({choice_parameter("fit", "How it is put into the texture of the hand",
                                         {"stretch", "contain", "cover"})}),
        file_(std::move(file)),
        changed_(changed),
        picture_(std::move(picture)) {}

  Result<bool> draw(const Moment&, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    if (!take_change()) return false;
    if (picture_.width() == 0) {
      auto again = renderer::read_premultiplied_picture(file_);
      if (!again) return tl::make_unexpected(again.error());
      picture_ = std::move(*again);
    }
    out = fitted(std::as_const(picture_).view(), out.width(), out.height(),
                 static_cast<Fit>(number("fit")));
    picture_ = {};  // it may be very large, and is seldom needed again
    return true;
  }

  bool is_stale() const override {
    const auto changed = changed_at(file_);
    return changed != changed_ && changed != fs::file_time_type{};
  }

 private:
  fs::path file_;
  fs::file_time_type changed_;
  renderer::Texture picture_;  ///< empty after it was drawn
};

}  // namespace

Result<std::unique_ptr<Source>> open_picture(const Opening& opening) {
  const fs::path file = opening.element.what;
  const auto changed = changed_at(file);
  auto picture = renderer::read_premultiplied_picture(file);
  if (!picture) return tl::make_unexpected(picture.error());
  return std::make_unique<PictureSource>(file, changed, std::move(*picture));
}

}  // namespace handcast::content
