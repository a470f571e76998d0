// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/rig_hand.hpp"

#include <handcast.h>

#include <algorithm>
#include <cstring>

#include "config/live/live_values.hpp"
#include "config/settings/settings.hpp"
#include "ipc/client/rig_ring.hpp"

namespace handcast::study {
namespace {

/// The sentence of the last call of the interface.
tl::unexpected<Error> failure(handcast_result result) {
  const auto code = result == HANDCAST_DISCONNECTED ? Errc::disconnected
                    : result == HANDCAST_WRONG_USE  ? Errc::bad_config
                                                    : Errc::unavailable;
  return fail(code, handcast_error());
}

/// The assignment that gives a setting its present value again.
Result<std::string> as_now(const config::LiveBoard& board, const std::string& path) {
  const auto now = board.now();
  if (!now) return tl::make_unexpected(now.error());
  auto rig = config::with_live(board.filed(), now->values.view());
  if (!rig) return tl::make_unexpected(rig.error());
  const auto listing = config::list_settings(*rig);
  const auto* setting = config::find_setting(listing, path);
  if (!setting) return path;  // set() says what is wrong
  return path + "=" + config::print_value(*setting);
}

/// Whether two assignments give a setting the same value, with or without quotes.
bool same(std::string a, std::string b) {
  std::erase(a, '"');
  std::erase(b, '"');
  return a == b;
}

}  // namespace

void RigHand::Close::operator()(handcast_content* content) const { handcast_close(content); }

Result<RigHand> RigHand::open(const std::string& rig, msg::Side side, int width_px, int height_px,
                              const std::string& program) {
  const auto ring = client::rig_ring(rig, "live.settings");  // says which rigs are up
  if (!ring) return tl::make_unexpected(ring.error());
  handcast_content* content = nullptr;
  const auto opened =
      handcast_open(ring->rig.c_str(), side == msg::Side::left ? HANDCAST_LEFT : HANDCAST_RIGHT,
                    width_px, height_px, &content);
  std::unique_ptr<handcast_content, Close> owned(content);
  if (opened != HANDCAST_OK) return failure(opened);
  auto board = config::LiveBoard::open(ring->rig);
  if (!board) return tl::make_unexpected(board.error());
  return RigHand(std::move(owned), std::move(*board), side, program);
}

RigHand::RigHand(RigHand&&) noexcept = default;

RigHand::~RigHand() {
  if (content_ && board_ && !afterwards_.empty())
    (void)board_->set(afterwards_, program_);  // a rig that is down needs nothing
}

Result<renderer::HandMesh> RigHand::mesh() const {
  const auto& files = board_->filed().hand;
  return renderer::load_hand_or_default(side_ == msg::Side::left ? files.left : files.right, side_);
}

Result<void> RigHand::wait() {
  constexpr int kPatience_ms = 100;
  const auto waited = handcast_wait(content_.get(), kPatience_ms);
  if (waited == HANDCAST_DISCONNECTED) return failure(waited);
  handcast_both_hands hands;
  const auto index = side_ == msg::Side::left ? HANDCAST_LEFT : HANDCAST_RIGHT;
  joints_.reset();
  if (waited != HANDCAST_OK || handcast_hands(content_.get(), &hands) != HANDCAST_OK ||
      !hands.is_there[index])
    return {};
  joints_.emplace();
  for (std::size_t joint = 0; joint < joints_->size(); ++joint) {
    const auto& at = hands.joints[index][joint].position_m;
    (*joints_)[joint] = {at[0], at[1], at[2]};
  }
  return {};
}

Result<void> RigHand::show(renderer::View<const std::uint32_t> picture) {
  std::uint8_t* pixels = handcast_begin(content_.get());
  if (!pixels) return {};
  for (int y = 0; y < picture.height; ++y)
    std::memcpy(pixels + std::size_t{4} * static_cast<std::size_t>(y * picture.width),
                picture.row(y), std::size_t{4} * static_cast<std::size_t>(picture.width));
  const auto shown = handcast_publish(content_.get(), 0);
  if (shown == HANDCAST_DISCONNECTED) return failure(shown);
  if (shown != HANDCAST_OK || is_shown_) return {};
  is_shown_ = true;
  const std::string path = side_ == msg::Side::left ? "content.left" : "content.right";
  return set({path + "=program:"});  // not before there is a picture: the hand would be dark
}

Result<void> RigHand::set(const std::vector<std::string>& assignments) {
  for (const auto& assignment : assignments) {
    const auto path = assignment.substr(0, assignment.find('='));
    const auto is_known = [&](const auto& kept) {
      return kept == path || kept.starts_with(path + "=");
    };
    if (std::ranges::any_of(afterwards_, is_known)) continue;
    auto before = as_now(*board_, path);
    if (!before) return tl::make_unexpected(before.error());
    // What is so already was left by a program that was killed: the value of the file comes back.
    afterwards_.push_back(same(*before, assignment) ? path : *before);
  }
  const auto set = board_->set(assignments, program_);
  return set ? Result<void>() : tl::make_unexpected(set.error());
}

}  // namespace handcast::study
