// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "services/content/projegraphy/studio.hpp"
#include "services/content/settable_source.hpp"
#include "services/content/skin_print.hpp"

namespace handcast::content {
namespace {

using projegraphy::FlatHand;
using projegraphy::Order;
using projegraphy::Silhouette;
using projegraphy::Studio;

constexpr std::uint32_t kBefore = 0xff404040;  ///< before the first animal
constexpr float kStill_m = 0.015f;  ///< how far joints move on a hand that is nearly still
constexpr float kSame = 0.82f;      ///< the overlap of silhouettes that are about the same
constexpr float kTogether = 0.3f;   ///< of a hand's size: hands that are nearer are one animal

/// A hand as it was.
struct KeptHand {
  HandState state;
  std::vector<glm::vec3> positions_m, normals;

  explicit KeptHand(const HandState& hand)
      : state(hand),
        positions_m(hand.positions_m.begin(), hand.positions_m.end()),
        normals(hand.normals.begin(), hand.normals.end()) {
    state.positions_m = positions_m;
    state.normals = normals;
  }
  KeptHand(KeptHand&&) = default;
  KeptHand& operator=(KeptHand&&) = default;
};

/// A picture that is being made, and the hands for which it is.
struct Commission {
  std::shared_ptr<const Order> order;
  KeptHand hand;
  std::optional<KeptHand> other;
};

bool is_seen(const HandState* hand) {
  return hand && hand->is_there && hand->mesh && !hand->positions_m.empty();
}

struct Box {
  glm::vec2 low{1e9f}, high{-1e9f};
  explicit Box(const FlatHand& hand) {
    for (const auto& px : hand.px) {
      low = glm::min(low, px);
      high = glm::max(high, px);
    }
  }
  float size() const { return std::max(high.x - low.x, high.y - low.y); }
};

/// True if two hands make one animal.
bool are_together(const FlatHand& a, const FlatHand& b) {
  const Box one(a), two(b);
  const glm::vec2 gap = glm::max(one.low - two.high, two.low - one.high);
  return std::max(gap.x, gap.y) < kTogether * std::max(one.size(), two.size());
}

/// Whether a hand and its neighbour have been nearly still, and since when.
class Stillness {
 public:
  /// Seconds for which nothing has moved far.
  double seconds(const Moment& moment) {
    const auto joints = joints_of(moment);
    const bool has_moved =
        joints.size() != anchor_.size() ||
        !std::ranges::equal(joints, anchor_, [](const glm::vec3& a, const glm::vec3& b) {
          return glm::distance(a, b) < kStill_m;
        });
    if (has_moved) {
      anchor_ = joints;
      since_s_ = moment.time_s;
      was_judged_ = false;
    }
    return moment.time_s - since_s_;
  }
  /// False once for each time that the hands are still.
  bool was_judged() { return std::exchange(was_judged_, true); }

 private:
  static std::vector<glm::vec3> joints_of(const Moment& moment) {
    std::vector<glm::vec3> joints;
    for (const HandState* hand : {moment.hand, moment.other})
      if (is_seen(hand)) joints.insert(joints.end(), hand->joints_m.begin(), hand->joints_m.end());
    return joints;
  }

  std::vector<glm::vec3> anchor_;
  double since_s_ = 0;
  bool was_judged_ = true;
};

/// Errors (bad_config): none that can be used. It is shown to people, and must hold no secret.
Result<void> check_address(std::string_view name, const std::string& address) {
  if (projegraphy::host_of(address).empty())
    return fail(Errc::bad_config,
                fmt::format("{} is no address of a server: write http://HOST:PORT", name));
  if (address.find('@') != address.npos)
    return fail(
        Errc::bad_config,
        fmt::format("{} holds a name or a password: put the key into a file (key=FILE)", name));
  return {};
}

/// The animal that the hands look like, painted on the skin of one of them.
class ProjegraphySource final : public SettableSource {
 public:
  ProjegraphySource(const Opening& opening, Viewer projector)
      : SettableSource(
            {number_parameter("after", "Seconds of still hands until they are looked at", 0, 60,
                              0.5),
             number_parameter("fade", "Seconds from one animal to the next", 0, 60, 0.6),
             plain_parameter("recogniser", "Address of a server that names the animal",
                             Parameter::Kind::text),
             plain_parameter("painter", "Address of a server that paints it",
                             Parameter::Kind::text),
             plain_parameter("workflow", "File with what it does, if it is ComfyUI",
                             Parameter::Kind::text),
             plain_parameter("model", "Model of the recogniser", Parameter::Kind::text),
             plain_parameter("key", "File with the address of the recogniser and its key",
                             Parameter::Kind::text),
             plain_parameter("style", "Begins the prompt of the painter", Parameter::Kind::text),
             number_parameter("patience", "Seconds for a request", 0.1, 60, 8),
             number_parameter("budget", "Requests in an hour", 0, 10000, 60),
             plain_parameter("wait", "Waits for a picture that is being made, as films need it",
                             Parameter::Kind::flag, {0})}),
        projector_(std::move(projector)),
        studio_(Studio::shared(opening.meshes)),
        print_(*opening.meshes[static_cast<std::size_t>(opening.side)], opening.width,
               opening.height),
        from_(opening.width, opening.height, kBefore),
        to_(from_),
        shown_(from_) {}

  Needs needs() const override { return {.surface = true}; }

  /// Errors, too: an address that is none, a file without a key.
  Result<void> set(std::string_view name, std::string_view value) override {
    if ((name == "recogniser" || name == "painter") && !value.empty())
      if (auto usable = check_address(name, std::string(value)); !usable) return usable;
    if (name == "key") {
      auto key = projegraphy::read_key(std::string(value));
      if (!key) return tl::make_unexpected(key.error());
      key_ = std::move(*key);
    }
    if (name == "workflow") {
      auto workflow =
          value.empty() ? Result<std::string>("") : projegraphy::read_workflow(std::string(value));
      if (!workflow) return tl::make_unexpected(workflow.error());
      workflow_ = std::move(*workflow);
    }
    return SettableSource::set(name, value);
  }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    const bool is_first = moment.frame == 0;
    take_change();
    if (is_seen(moment.hand)) look(moment);
    const bool waits = number("wait") != 0;
    if (commission_ && waits) commission_->order->wait();
    if (commission_ && !baking_.valid() && commission_->order->is_done()) begin_baking();
    if (baking_.valid() &&
        (waits || baking_.wait_for(std::chrono::seconds(0)) == std::future_status::ready))
      begin_fade(moment.time_s);
    const bool has_changed = fade(moment.time_s) || is_first;
    if (has_changed) out.pixels() = shown_.pixels();
    return has_changed;
  }

 private:
  /// Commissions a picture if the hands are still and look like something else.
  void look(const Moment& moment) {
    if (stillness_.seconds(moment) < number("after") || stillness_.was_judged()) return;
    const HandState* other = nullptr;
    auto silhouette = seen(moment, other);
    if (silhouette.area_px == 0 || (last_ && overlap_of(*last_, silhouette) > kSame)) return;
    last_ = silhouette;
    std::optional<KeptHand> kept;
    if (other) kept.emplace(*other);
    commission_.emplace(Commission{studio_->order(std::move(silhouette), servers()),
                                   KeptHand(*moment.hand), std::move(kept)});
  }

  projegraphy::Servers servers() const {
    projegraphy::Servers servers;
    servers.recogniser = text("recogniser");
    servers.painter = text("painter");
    servers.workflow = workflow_;
    servers.model = text("model").empty() ? "gpt-4o" : text("model");
    if (!text("style").empty()) servers.style = text("style");
    servers.key = key_.for_server(servers.recogniser);
    servers.patience_s = number("patience");
    servers.per_hour = static_cast<int>(number("budget"));
    return servers;
  }

  /// The silhouette of the hand, or of both if they are together; the left one comes first.
  Silhouette seen(const Moment& moment, const HandState*& other) const {
    std::vector<FlatHand> flat{flattened(*moment.hand)};
    if (is_seen(moment.other)) {
      auto second = flattened(*moment.other);
      if (are_together(flat[0], second)) {
        other = moment.other;
        flat.insert(moment.hand->side == Side::left ? flat.end() : flat.begin(), std::move(second));
      }
    }
    return silhouette_of(flat);
  }
  FlatHand flattened(const HandState& hand) const {
    FlatHand flat{hand.mesh, {}};
    for (const auto& at : hand.positions_m)
      flat.px.push_back(at.z > 0.05f ? projector_.pixel_of(at) : glm::vec2(1e9f));
    return flat;
  }

  /// Puts the new picture on the skin as it was when the hands were looked at, on a thread: it
  /// takes longer than a picture of the content may.
  void begin_baking() {
    auto done = std::make_shared<const Commission>(std::move(*commission_));
    commission_.reset();
    if (!done->order->recognised()) return;
    baking_ = std::async(
        std::launch::async,
        [this, done, baked = renderer::Texture(shown_.width(), shown_.height())]() mutable {
          projegraphy::give_way();
          const Silhouette& silhouette = done->order->silhouette();
          const float scale =
              silhouette.scale * projegraphy::kPictureSide_px / projegraphy::kMaskSide_px;
          print_.clear();
          print_.take(projector_, done->hand.state, done->other ? &done->other->state : nullptr,
                      done->order->picture(),
                      {glm::vec2(scale), 0.5f - silhouette.origin_px * scale});
          print_.show(true, baked);
          return std::move(baked);
        });
  }
  void begin_fade(double time_s) {
    from_ = shown_;
    to_ = baking_.get();
    fading_since_s_ = time_s;
  }

  /// Mixes the last animal and the new one. Returns whether anything changes.
  bool fade(double time_s) {
    if (!fading_since_s_) return false;
    const double seconds = number("fade"), since_s = time_s - *fading_since_s_;
    const double part = seconds > 0 ? std::clamp(since_s / seconds, 0., 1.) : 1;
    if (part >= 1) fading_since_s_.reset();
    const auto share = static_cast<std::uint32_t>(std::lround(256 * part));
    for (std::size_t i = 0; i < shown_.pixels().size(); ++i)
      shown_.pixels()[i] = mixed(from_.pixels()[i], to_.pixels()[i], share);
    return true;
  }
  /// `share` of `b` by 256, two channels at a time.
  static std::uint32_t mixed(std::uint32_t a, std::uint32_t b, std::uint32_t share) {
    constexpr std::uint32_t kEven = 0x00ff00ff;
    const std::uint32_t even = ((a & kEven) * (256 - share) + (b & kEven) * share) >> 8 & kEven,
                        odd =
                            ((a >> 8 & kEven) * (256 - share) + (b >> 8 & kEven) * share) & ~kEven;
    return even | odd;
  }

  Viewer projector_;
  std::shared_ptr<Studio> studio_;
  projegraphy::ServerKey key_ =
      projegraphy::read_key("").value_or(projegraphy::ServerKey());  ///< in no sentence
  std::string workflow_;                                             ///< of the painter
  SkinPrint print_;  ///< of the thread that bakes, while there is one
  Stillness stillness_;
  std::optional<Silhouette> last_;        ///< that was looked at
  std::optional<Commission> commission_;  ///< that is being made
  renderer::Texture from_, to_, shown_;
  std::optional<double> fading_since_s_;
  std::future<renderer::Texture> baking_;  ///< the last member: it ends first
};

}  // namespace

Result<std::unique_ptr<Source>> open_projegraphy(const Opening& opening) {
  return std::make_unique<ProjegraphySource>(
      opening, viewer_of(opening.calibration ? *opening.calibration : calib::reference_rig()));
}

}  // namespace handcast::content
