// SPDX-License-Identifier: Apache-2.0
#include "renderer/kms/card.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <xf86drm.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "renderer/kms/pipe.hpp"
#include "renderer/output/edid.hpp"

namespace handcast::renderer::kms {
namespace {

constexpr int kMostCards = 64;

Result<void> require(bool works, const std::string& path, std::string_view what) {
  if (works) return {};
  return fail(Errc::bad_config,
              fmt::format("'{}' has no {}; use the back end 'window' on this card", path, what));
}

bool is_one(int card, std::uint64_t capability) {
  std::uint64_t value = 0;
  return drmGetCap(card, capability, &value) == 0 && value == 1;
}

Error why_not_opened(const std::string& path, int number) {
  if (number == EACCES || number == EPERM)
    return {Errc::bad_config,
            fmt::format("'{}' may not be opened; add this user to the group "
                        "video (`sudo usermod -aG video $USER`), and log in again",
                        path)};
  return {Errc::unavailable, fmt::format("'{}' cannot be opened: {}", path, std::strerror(number))};
}

std::string model_at(int card, const drmModeConnector& connector) {
  for (int i = 0; i < connector.count_props; ++i) {
    const Owned<drmModePropertyRes> property(drmModeGetProperty(card, connector.props[i]));
    if (!property || std::strcmp(property->name, "EDID") != 0) continue;
    const Owned<drmModePropertyBlobRes> blob(
        drmModeGetPropertyBlob(card, static_cast<std::uint32_t>(connector.prop_values[i])));
    if (blob) return model_of({static_cast<const std::uint8_t*>(blob->data), blob->length});
  }
  return {};
}

Display display_of(int card, const std::string& path, const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  Display display{.card = path,
                  .connector_id = connector.connector_id,
                  .connector = fmt::format("{}-{}", type != nullptr ? type : "Unknown",
                                           connector.connector_type_id),
                  .model = model_at(card, connector),
                  .is_connected = connector.connection == DRM_MODE_CONNECTED,
                  .modes = {}};
  for (int i = 0; i < connector.count_modes; ++i)
    if (const auto mode = mode_of(connector.modes[i]);
        mode.rate_hz > 0 && (mode.timing.flags & DRM_MODE_FLAG_INTERLACE) == 0)
      display.modes.push_back(mode);
  std::stable_partition(display.modes.begin(), display.modes.end(), [](const Mode& mode) {
    return (mode.timing.type & DRM_MODE_TYPE_PREFERRED) != 0;
  });
  return display;
}

/// The cards to search: all that exist, or only the one in the settings.
std::vector<std::string> paths_for(const std::string& path) {
  if (!path.empty()) return {path};
  std::vector<std::string> paths;
  paths.reserve(kMostCards);
  for (int i = 0; i < kMostCards; ++i) paths.push_back(fmt::format("/dev/dri/card{}", i));
  return paths;
}

}  // namespace

Result<UniqueFd> open_card(const std::string& path) {
  UniqueFd card(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (!card) return tl::make_unexpected(why_not_opened(path, errno));
  if (auto works = require(Owned<drmModeRes>(drmModeGetResources(card.get())) != nullptr, path,
                           "displays (it only computes)");
      !works)
    return tl::make_unexpected(works.error());
  for (const auto& [works, what] :
       {std::pair(drmSetClientCap(card.get(), DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) == 0 &&
                      drmSetClientCap(card.get(), DRM_CLIENT_CAP_ATOMIC, 1) == 0,
                  "atomic mode setting"),
        std::pair(is_one(card.get(), DRM_CAP_DUMB_BUFFER), "buffers that the processor can write"),
        std::pair(is_one(card.get(), DRM_CAP_TIMESTAMP_MONOTONIC),
                  "time stamps of CLOCK_MONOTONIC")})
    if (auto required = require(works, path, what); !required)
      return tl::make_unexpected(required.error());
  return card;
}

std::vector<Display> displays_of(int card, const std::string& path) {
  std::vector<Display> displays;
  const Owned<drmModeRes> resources(drmModeGetResources(card));
  for (int i = 0; resources && i < resources->count_connectors; ++i)
    if (const Owned<drmModeConnector> connector(
            drmModeGetConnector(card, resources->connectors[i]));
        connector)
      displays.push_back(display_of(card, path, *connector));
  return displays;
}

Display display_at(int card, const std::string& path, std::uint32_t connector_id) {
  const Owned<drmModeConnector> connector(drmModeGetConnector(card, connector_id));
  return connector ? display_of(card, path, *connector) : Display();
}

bool is_plugged(int card, std::uint32_t connector_id) {
  const Owned<drmModeConnector> connector(drmModeGetConnectorCurrent(card, connector_id));
  return connector && connector->connection == DRM_MODE_CONNECTED;
}

Result<void> take_control(int card, const std::string& path) {
  if (drmIsMaster(card) != 0 || drmSetMaster(card) == 0) return {};
  return fail(Errc::unavailable,
              fmt::format("another program shows pictures on '{}', as a desktop (X, Wayland) does; "
                          "end it (`sudo systemctl isolate multi-user.target` ends a desktop), or "
                          "use the back end 'window'",
                          path));
}

Result<Found> find_display(const std::string& path, std::string_view wanted) {
  std::vector<UniqueFd> cards;
  std::vector<Display> displays;
  std::vector<std::size_t> card_of;  // by display
  std::optional<Error> refusal;
  for (const auto& card_path : paths_for(path)) {
    auto card = open_card(card_path);
    if (!card) {
      if (!refusal || refusal->code == Errc::unavailable) refusal = card.error();
      continue;
    }
    for (auto& display : displays_of(card->get(), card_path)) {
      displays.push_back(std::move(display));
      card_of.push_back(cards.size());
    }
    cards.push_back(std::move(*card));
  }
  if (cards.empty() && path.empty() && refusal->code == Errc::unavailable)
    return fail(Errc::unavailable,
                "there is no graphics card /dev/dri/card0 to card63; its driver may be missing");
  if (cards.empty()) return tl::make_unexpected(*refusal);
  const auto chosen = choose_display(displays, wanted);
  if (!chosen) return tl::make_unexpected(chosen.error());
  return Found{std::move(cards[card_of[*chosen]]), std::move(displays[*chosen])};
}

}  // namespace handcast::renderer::kms
