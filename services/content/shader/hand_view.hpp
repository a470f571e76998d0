// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "services/content/shader/user_program.hpp"
#include "services/content/source.hpp"
#include "services/content/surface_map.hpp"

namespace handcast::content::shader {

/// What a shader mentions of the hands, as uniforms and textures. Of the hand that wears it
/// ("hand_") and of the other one ("other_"):
///
///     int there, side              1 if the hand is seen; 0 left, 1 right
///     vec3 joint[26]               camera space, m
///     vec3 rest_joint[26]          at rest, mm, in the axes of the wrist
///     vec2 palm_uv[26], back_uv[26]  under the palm and the back, as isf_FragNormCoord
///     float pinch, spread, curl    0..1 (HandState)
///     float speed                  m/s
///     vec3 normal, gravity         HandState::palm_normal, HandState::gravity
///
/// and of the hand that wears it, per texel, continued some texels beyond the charts:
///
///     sampler2D hand_rest            xyz: at rest, mm, in the axes of the wrist (x to the right,
///                                    y out of the back, z to the arm; the thumb of a left hand is
///                                    at +x, that of a right one at -x); w: 1 on the back, -1 on
///                                    the palm, 0 far from the charts
///     sampler2D hand_bone            x: the joint with the largest weight; y: texels to the
///                                    outline of the chart, at most 32, negative beyond it; z: 0..1
///                                    along the bone that begins there; w: 1, far from the charts 0
///     sampler2D hand_position        xyz: camera space, m; w as above
///     sampler2D hand_surface_normal  about unit length, camera space
///
/// The last two have half the width and height of the picture, as they are drawn for each picture:
/// read them with texture().
class HandView {
 public:
  /// For a shader with these identifiers. `opening`: size, meshes and side; without meshes, maps
  /// and places are zero.
  HandView(const std::set<std::string, std::less<>>& words, const Opening& opening);

  /// The declarations, for the preludes.
  std::string declarations() const;
  /// The names of the maps, in the order of images().
  const std::vector<std::string>& samplers() const { return samplers_; }
  /// What it needs of a moment.
  Needs needs() const;
  /// True if it mentions a hand that moves.
  bool is_live() const { return is_live_; }

  /// Makes the maps of a moment.
  void update(Graphics& graphics, const Moment& moment);
  /// The maps.
  std::vector<const Texels*> images() const;
  /// Sets the uniforms.
  void set(const UserProgram& program, const Moment& moment) const;

 private:
  /// Where the joints of one hand lie at rest.
  struct Places {
    std::array<glm::vec3, kJoints> rest_mm{};
    std::array<glm::vec2, kJoints> palm_uv{}, back_uv{};
  };
  /// From one joint to the next.
  struct Bone {
    glm::vec3 begin_mm{}, along_by_mm{};  ///< the dot product with the latter: how far along
  };
  /// A texel off the charts, and the nearest one on them.
  struct Beside {
    std::uint32_t to, from;
    float distance_px;
  };
  /// The hand in a map of a size.
  struct Layout {
    int width, height;
    std::shared_ptr<const SurfaceMap> surface;
    std::vector<Beside> beside;
    std::vector<float> edge_px;  ///< per texel of the map
  };
  bool mentions(std::string_view prefix, std::string_view name) const;
  static Layout lay_out(const renderer::HandMesh& mesh, int width, int height);
  static std::array<Bone, kJoints> bones_of(const renderer::HandMesh& mesh);
  static Places places_on(const renderer::HandMesh& mesh, int width, int height);
  void set_hand(const UserProgram& program, const std::string& prefix, const HandState& hand,
                const Places& places) const;
  glm::vec4 at_rest(const SurfaceTexel& texel) const;
  glm::vec4 on_bone(const SurfaceTexel& texel, float edge_px) const;
  void draw_map(std::size_t index, const Layout& layout, const HandState& hand);

  std::set<std::string, std::less<>> words_;
  std::array<const renderer::HandMesh*, 2> meshes_;  ///< that wears it, the other
  Side side_;
  int width_, height_;
  std::optional<Layout> at_rest_, live_;  ///< if there are such maps
  std::vector<float> facing_;             ///< per chart: 1 on the back, -1 on the palm
  std::vector<glm::vec3> rest_mm_;        ///< per vertex
  std::vector<int> ruling_;               ///< ruling_joints()
  std::array<Bone, kJoints> bones_{};
  std::array<Places, 2> places_;
  std::vector<std::string> samplers_;
  std::vector<Texels> images_;
  std::vector<glm::vec4> scratch_;
  bool is_live_ = false;
};

}  // namespace handcast::content::shader
