// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/exchange.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>

#include "ipc/base/unique_fd.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/projegraphy/painter.hpp"

namespace handcast::projegraphy {
namespace {

constexpr std::uint32_t kLargestPainting_px = 2048;

/// True for a PNG file of a size that is worth the memory.
bool is_small_png(const std::string& bytes) {
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t k = 0; k < 4; ++k)
      number = number << 8 | static_cast<std::uint8_t>(bytes[at + k]);
    return number;
  };
  constexpr std::size_t kWidth = 16, kHeight = 20, kHead = 24;
  return bytes.size() > kHead && bytes.starts_with("\x89PNG\r\n") &&
         std::max(number_at(kWidth), number_at(kHeight)) <= kLargestPainting_px;
}

/// Reads the bytes of a picture by a file in memory.
Result<renderer::Texture> decoded(const std::string& bytes) {
  if (!is_small_png(bytes)) return fail(Errc::bad_data, "not a PNG picture");
  const UniqueFd memory(memfd_create("handcast-painting", MFD_CLOEXEC));
  if (!memory || write(memory.get(), bytes.data(), bytes.size()) != std::ssize(bytes))
    return fail(Errc::unavailable, "there is no memory for a picture");
  return renderer::read_picture(fmt::format("/proc/self/fd/{}", memory.get()));
}

/// As large as the pictures of the painter that is built in.
renderer::Texture resized(const renderer::Texture& picture) {
  renderer::Texture out(kPictureSide_px, kPictureSide_px);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out.at(x, y) =
          picture.at(x * picture.width() / out.width(), y * picture.height() / out.height());
  return out;
}

}  // namespace

std::string prompt_of(const Servers& servers, std::string_view animal) {
  return fmt::format("{} {}, centred, plain background", servers.style, animal);
}

Result<std::string> mask_png(const Silhouette& silhouette) {
  auto mask = silhouette.mask;
  for (auto& level : mask.pixels()) level = level ? 255 : 0;
  return renderer::png_of(std::as_const(mask).view());
}

Result<renderer::Texture> picture_in(const std::string& bytes) {
  return decoded(bytes).map(resized);
}

std::string without_slash(std::string url) {
  while (url.ends_with('/')) url.pop_back();
  return url;
}

std::string text_of(const nlohmann::json& what) {
  return what.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void rest(std::chrono::milliseconds time, const std::stop_token& stop) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any never;
  never.wait_for(lock, stop, time, [] { return false; });
}

}  // namespace handcast::projegraphy
