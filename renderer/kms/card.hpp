// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "renderer/kms/display.hpp"

namespace handcast::renderer::kms {

/// Opens a graphics card for atomic mode setting. Errors: bad_config (not permitted, or its driver
/// cannot do it), unavailable (there is no such card).
Result<UniqueFd> open_card(const std::string& path);

/// The connectors of a card. Asks the displays for their modes, which takes up to a second.
std::vector<Display> displays_of(int card, const std::string& path);
/// One connector of them; not connected if it is gone.
Display display_at(int card, const std::string& path, std::uint32_t connector_id);

/// Whether a display is plugged in, as the kernel knows it without asking the display. Any thread.
bool is_plugged(int card, std::uint32_t connector_id);

/// Becomes the only program that may show pictures on the card ("DRM master"), until it is closed.
/// Errors: unavailable (another program is it).
Result<void> take_control(int card, const std::string& path);

/// A card and one of its displays.
struct Found {
  UniqueFd card;
  Display display;
};
/// Opens the card at `path`, or, if it is empty, the one with the display. `wanted`: see
/// choose_display(). Errors: those of open_card() and choose_display().
Result<Found> find_display(const std::string& path, std::string_view wanted);

}  // namespace handcast::renderer::kms
