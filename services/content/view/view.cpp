// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "ipc/base/quote.hpp"
#include "services/content/settable_source.hpp"
#include "services/content/unwrap.hpp"

namespace handcast::content {
namespace {

constexpr int kMostSide_px = 2048;  ///< of the picture, whatever the projector has

/// Which vertices of a hand are neighbours on the skin, across the seams of its texture, too.
class SkinGraph {
 public:
  explicit SkinGraph(const renderer::HandMesh& mesh) {
    std::map<std::array<float, 3>, std::size_t> known;
    for (const auto& at : mesh.positions)
      place_.push_back(known.try_emplace({at.x, at.y, at.z}, known.size()).first->second);
    neighbours_.resize(known.size());
    for (const auto& triangle : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = place_[triangle[k]], b = place_[triangle[(k + 1) % 3]];
        neighbours_[a].push_back(b);
        neighbours_[b].push_back(a);
      }
  }

  /// The means of sums per vertex and their weights. Vertices at one place share theirs. One
  /// without a weight gets the mean of its neighbours, ring by ring; 0 if none is connected to it.
  std::vector<glm::vec4> spread(std::span<const glm::vec4> sums,
                                std::span<const float> weights) const {
    std::vector<glm::vec4> means(neighbours_.size(), glm::vec4(0));
    std::vector<float> total(neighbours_.size());
    for (std::size_t v = 0; v < place_.size(); ++v) {
      means[place_[v]] += sums[v];
      total[place_[v]] += weights[v];
    }
    std::vector<std::size_t> ring;
    for (std::size_t i = 0; i < means.size(); ++i) {
      if (total[i] == 0) continue;
      means[i] /= total[i];
      ring.push_back(i);
    }
    while (!ring.empty()) ring = grow(ring, means, total);
    std::vector<glm::vec4> per_vertex;
    for (const auto place : place_) per_vertex.push_back(means[place]);
    return per_vertex;
  }

 private:
  /// Gives the neighbours of a ring that have nothing their means, and returns them.
  std::vector<std::size_t> grow(const std::vector<std::size_t>& ring, std::vector<glm::vec4>& means,
                                std::vector<float>& total) const {
    std::vector<std::size_t> next;
    for (const auto from : ring)
      for (const auto to : neighbours_[from])
        if (total[to] == 0) next.push_back(to);
    std::ranges::sort(next);
    next.erase(std::unique(next.begin(), next.end()), next.end());
    for (const auto to : next) {
      float count = 0;
      for (const auto from : neighbours_[to]) {
        if (total[from] == 0) continue;
        means[to] += means[from];
        ++count;
      }
      means[to] /= count;
    }
    for (const auto to : next) total[to] = 1;
    return next;
  }

  std::vector<std::size_t> place_;                    ///< per vertex
  std::vector<std::vector<std::size_t>> neighbours_;  ///< per place
};

/// The levels of a texel, 0..255.
glm::vec4 levels_of(std::uint32_t texel) {
  return {texel & 0xff, texel >> 8 & 0xff, texel >> 16 & 0xff, texel >> 24};
}

std::uint32_t packed(const glm::vec4& levels) {
  std::uint32_t texel = 0;
  for (int c = 3; c >= 0; --c)
    texel = texel << 8 | static_cast<std::uint32_t>(std::clamp(levels[c] + 0.5f, 0.f, 255.f));
  return texel;
}

/// The picture at a place, interpolated linearly; its edge is continued.
std::uint32_t sample(const renderer::Texture& picture, const glm::vec2& place) {
  const glm::vec2 at =
      glm::clamp(place, glm::vec2(0), glm::vec2(picture.width() - 1, picture.height() - 1));
  const int x = static_cast<int>(at.x), y = static_cast<int>(at.y),
            right = std::min(x + 1, picture.width() - 1),
            below = std::min(y + 1, picture.height() - 1);
  const glm::vec2 part = at - glm::vec2(x, y);
  const auto mix = [&](int row) {
    return glm::mix(levels_of(picture.at(x, row)), levels_of(picture.at(right, row)), part.x);
  };
  return packed(glm::mix(mix(y), mix(below), part.y));
}

/// What another source draws in the plane of the projector, unwrapped onto the hand that moves
/// through it. Where the light does not reach the skin, what was there last; where it never did,
/// the colours of the skin around.
class ViewSource final : public SettableSource {
 public:
  ViewSource(const Opening& opening, std::unique_ptr<Source> inner, const Opening& inner_opening,
             Viewer projector)
      : SettableSource(
            {plain_parameter("bake", "Stays on the skin, and no longer moves under it",
                             Parameter::Kind::flag, {0}),
             number_parameter("after", "Seconds of a hand in view until it is baked", 0, 3600, 0),
             plain_parameter("fill", "Skin that was never lit gets the colours around it",
                             Parameter::Kind::flag, {1})}),
        inner_(std::move(inner)),
        projector_(std::move(projector)),
        mesh_(*opening.meshes[static_cast<std::size_t>(opening.side)]),
        map_(surface_map_of(mesh_, opening.width, opening.height)),
        graph_(mesh_),
        picture_(inner_opening.width, inner_opening.height),
        texels_(map_->texels().size()),
        is_lit_(map_->texels().size()) {
    const auto own = SettableSource::parameters(), its = inner_->parameters();
    all_.assign(own.begin(), own.end());
    all_.insert(all_.end(), its.begin(), its.end());
  }

  Needs needs() const override {
    Needs needs{.surface = true};
    return needs |= inner_->needs();
  }
  std::span<const Parameter> parameters() const override { return all_; }
  Result<void> set(std::string_view name, std::string_view value) override {
    const auto own = SettableSource::parameters();
    if (std::ranges::count(own, name, &Parameter::name) > 0)
      return SettableSource::set(name, value);
    if (std::ranges::count(all_, name, &Parameter::name) > 0) return inner_->set(name, value);
    return Source::set(name, value);
  }
  bool is_stale() const override { return inner_->is_stale(); }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    renderer::Texture& out) override {
    bool has_changed = take_change() || moment.frame == 0;
    if (number("bake") == 0) is_baked_ = false;
    if (!is_baked_) {
      const auto looked = look(moment);
      if (!looked) return looked;
      has_changed = *looked || has_changed;
    }
    if (has_changed) show(out);
    return has_changed;
  }

 private:
  /// Draws the picture, and takes it where it falls onto the hand. Returns whether it does.
  Result<bool> look(const Moment& moment) {
    Moment its = moment;
    its.frame = pictures_;
    const auto drew = inner_->draw(its, {}, picture_);
    if (!drew) return drew;
    pictures_ += *drew;
    const bool is_there = !moment.hand->positions_m.empty();
    if (!is_there) since_s_ = -1;
    if (!is_there) return false;
    if (since_s_ < 0) since_s_ = moment.time_s;
    const glm::vec2 scale(static_cast<float>(picture_.width()) / projector_.width_px,
                          static_cast<float>(picture_.height()) / projector_.height_px);
    for (const auto& [which, px] : seen_texels(projector_, *map_, *moment.hand, moment.other)) {
      texels_[which] = sample(picture_, (px + 0.5f) * scale - 0.5f);
      is_lit_[which] = true;
    }
    is_baked_ = number("bake") != 0 && moment.time_s - since_s_ >= number("after");
    return true;
  }

  void show(renderer::Texture& out) const {
    const auto texels = map_->texels();
    const bool is_filled = number("fill") != 0;
    const auto around = is_filled ? colours_around() : std::vector<glm::vec4>();
    for (std::size_t i = 0; i < texels.size(); ++i) {
      std::uint32_t& texel = out.pixels()[texels[i].index];
      if (is_lit_[i])
        texel = texels_[i];
      else
        texel = is_filled ? packed(texels[i].of(std::span(around))) : 0;
    }
    map_->pad(out);
  }

  /// Per vertex: the levels of the lit texels around it, or those of the nearest lit skin.
  std::vector<glm::vec4> colours_around() const {
    const auto texels = map_->texels();
    std::vector<glm::vec4> sums(mesh_.vertex_count(), glm::vec4(0));
    std::vector<float> weights(mesh_.vertex_count());
    for (std::size_t i = 0; i < texels.size(); ++i) {
      if (!is_lit_[i]) continue;
      const glm::vec4 levels = levels_of(texels_[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        sums[texels[i].corners[k]] += texels[i].parts[k] * levels;
        weights[texels[i].corners[k]] += texels[i].parts[k];
      }
    }
    return graph_.spread(sums, weights);
  }

  std::unique_ptr<Source> inner_;
  std::vector<Parameter> all_;  ///< its own, and those of the inner source
  Viewer projector_;
  const renderer::HandMesh& mesh_;
  std::shared_ptr<const SurfaceMap> map_;
  SkinGraph graph_;
  renderer::Texture picture_;          ///< of the inner source
  std::uint64_t pictures_ = 0;         ///< that it has drawn
  std::vector<std::uint32_t> texels_;  ///< per texel of the map, as last lit
  std::vector<bool> is_lit_;           ///< whether it ever was
  double since_s_ = -1;                ///< since when the hand is there; -1: it is not
  bool is_baked_ = false;
};

/// Of the picture that lies in the projector's plane.
Opening inner_opening_of(const Opening& opening, config::ContentElement element,
                         const Viewer& projector) {
  Opening inner = opening;
  inner.element = std::move(element);
  const int longer = std::max(projector.width_px, projector.height_px);
  const double scale = std::min(1., static_cast<double>(kMostSide_px) / longer);
  inner.width = std::max(1, static_cast<int>(projector.width_px * scale));
  inner.height = std::max(1, static_cast<int>(projector.height_px * scale));
  return inner;
}

}  // namespace

Result<std::unique_ptr<Source>> open_view(const Opening& opening) {
  const auto written = config::parse_content(opening.element.what);
  if (!written) return tl::make_unexpected(written.error());
  const auto projector =
      viewer_of(opening.calibration ? *opening.calibration : calib::reference_rig());
  const auto inner = inner_opening_of(opening, (*written)[0], projector);
  auto source = open_source(inner);
  if (!source) return source;
  if (written->size() > 1 || (*source)->inputs() > 0)
    return fail(Errc::bad_config,
                fmt::format("{} is no single source; filters are put behind it, as in "
                            "\"view:film.mp4 | glow.fs\"",
                            quote(opening.element.what)));
  return std::make_unique<ViewSource>(opening, std::move(*source), inner, projector);
}

}  // namespace handcast::content
