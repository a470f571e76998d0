// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/kms/emulated_card.hpp"

#include <drm_fourcc.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/renderer/kms/emulated_kernel.hpp"
#include "tests/renderer/output/edid_block.hpp"

namespace handcast::test {
namespace {

/// A card for a process that is not a test: HANDCAST_EMULATED_CARD is the model of a display with
/// the size of the paper's projector.
[[maybe_unused]] const std::unique_ptr<EmulatedCard> from_environment = [] {
  hide("/dev/dri/");
  const char* model = std::getenv("HANDCAST_EMULATED_CARD");
  if (model == nullptr || *model == 0) return std::unique_ptr<EmulatedCard>();
  auto card = std::make_unique<EmulatedCard>();
  card->plug_in("HDMI-A-1", model, {timing(1024, 768, 60)});
  return card;
}();

}  // namespace

drmModeModeInfo timing(int width, int height, double rate_hz, std::uint32_t type) {
  drmModeModeInfo mode{};
  mode.hdisplay = static_cast<std::uint16_t>(width);
  mode.vdisplay = static_cast<std::uint16_t>(height);
  mode.htotal = static_cast<std::uint16_t>(width + 160);
  mode.vtotal = static_cast<std::uint16_t>(height + 40);
  mode.clock = static_cast<std::uint32_t>(std::lround(rate_hz * mode.htotal * mode.vtotal / 1e3));
  mode.vrefresh = static_cast<std::uint32_t>(std::lround(rate_hz));
  mode.type = type;
  return mode;
}

EmulatedCard::EmulatedCard() : kernel_(std::make_shared<Kernel>()) { attach(kernel_); }
EmulatedCard::~EmulatedCard() { detach(kernel_.get()); }

void EmulatedCard::set(const Faults& faults) {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->faults_ = faults;
}

void EmulatedCard::plug_in(const std::string& connector, const std::string& model,
                           std::vector<drmModeModeInfo> modes) {
  const std::lock_guard lock(kernel_->mutex_);
  const auto found = std::ranges::find(kernel_->connectors_, connector, &Kernel::Connector::name);
  found->modes = std::move(modes);
  const auto edid = edid_with(model + "\n");
  kernel_->values_[{found->id, kernel_->property("EDID")}] =
      kernel_->add_blob(edid.data(), edid.size());
}

void EmulatedCard::unplug(const std::string& connector) {
  const std::lock_guard lock(kernel_->mutex_);
  std::ranges::find(kernel_->connectors_, connector, &Kernel::Connector::name)->modes.clear();
}

renderer::Image<std::uint32_t> EmulatedCard::scanned(const std::string& connector) const {
  const std::lock_guard lock(kernel_->mutex_);
  const auto* shown = kernel_->scanned_by(kernel_->crtc_of(connector));
  if (shown == nullptr) return {};
  renderer::Image<std::uint32_t> picture(static_cast<int>(shown->width),
                                         static_cast<int>(shown->height));
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const auto value = *kernel_->pixel(*shown, x, y);
      const auto rgb = shown->format == DRM_FORMAT_XBGR8888
                           ? value & 0xffffff
                           : (value & 0xff00) | (value & 0xff) << 16 | (value >> 16 & 0xff);
      picture.at(x, y) = 0xff000000u | rgb;
    }
  return picture;
}

std::string EmulatedCard::lit_mode(const std::string& connector) const {
  const std::lock_guard lock(kernel_->mutex_);
  const auto crtc = kernel_->crtc_of(connector);
  const auto* mode = crtc == 0 ? nullptr : kernel_->mode_of(crtc, kernel_->values_);
  if (mode == nullptr || kernel_->value(crtc, "ACTIVE") == 0) return "";
  return fmt::format("{}x{}@{}", mode->hdisplay, mode->vdisplay, mode->vrefresh);
}

std::vector<EmulatedCard::Flip> EmulatedCard::flips() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->flips_;
}
int EmulatedCard::modesets() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->modesets_;
}
int EmulatedCard::torn() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->torn_;
}
int EmulatedCard::probes() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->probes_;
}
int EmulatedCard::framebuffers() const {
  const std::lock_guard lock(kernel_->mutex_);
  return static_cast<int>(std::ranges::count_if(
      kernel_->framebuffers_, [](const auto& entry) { return entry.second.owner >= 0; }));
}

void EmulatedCard::scribble(int x, int y, std::uint32_t value) {
  const std::lock_guard lock(kernel_->mutex_);
  for (const auto& [id, framebuffer] : kernel_->framebuffers_)
    if (framebuffer.owner >= 0) *kernel_->pixel(framebuffer, x, y) = value;
}

std::vector<std::uint32_t> EmulatedCard::pixels_at(int x, int y) const {
  const std::lock_guard lock(kernel_->mutex_);
  std::vector<std::uint32_t> pixels;
  for (const auto& [id, framebuffer] : kernel_->framebuffers_)
    if (framebuffer.owner >= 0) pixels.push_back(*kernel_->pixel(framebuffer, x, y));
  return pixels;
}

std::map<std::string, std::string> EmulatedCard::state() const {
  const std::lock_guard lock(kernel_->mutex_);
  std::map<std::string, std::string> state;
  for (const auto& [key, value] : kernel_->values_) {
    const auto& property = kernel_->properties_.at(key.second);
    std::string text = std::to_string(value);
    if ((property.flags & DRM_MODE_PROP_BLOB) != 0 && value != 0) {
      const auto& blob = kernel_->blobs_.at(static_cast<Kernel::Id>(value));
      text.assign(blob.begin(), blob.end());
    }
    state[fmt::format("{}.{}", key.first, property.name)] = text;
  }
  return state;
}

void EmulatedCard::set_colour_table() {
  const std::lock_guard lock(kernel_->mutex_);
  kernel_->values_[{51, kernel_->property("GAMMA_LUT")}] = kernel_->add_blob("dimmed", 6);
}

bool EmulatedCard::shows_cursor() const {
  const std::lock_guard lock(kernel_->mutex_);
  return kernel_->value(63, "FB_ID") != 0;
}

}  // namespace handcast::test
