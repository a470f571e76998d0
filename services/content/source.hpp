// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "config/content_chain.hpp"
#include "ipc/base/result.hpp"
#include "ipc/shm/open_ring.hpp"
#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::content {

using renderer::kJoints;
using renderer::Side;

/// A hand at a moment, for content that reacts to it. A hand that is not there is at rest.
struct HandState {
  bool is_there = false;
  Side side = Side::left;
  /// Camera space, m: x to the right, y down, z forward.
  /// @{
  std::array<glm::vec3, kJoints> joints_m{};
  glm::vec3 palm_normal{0, 0, -1};  ///< out of the palm, unit length
  glm::vec3 velocity_m_s{0};        ///< of the palm
  /// @}
  /// Smooth functions of the joints, for hands of any size: see derive().
  /// @{
  float pinch = 0;   ///< 1: the tips of thumb and index finger touch; 0: 6 cm or more apart
  float spread = 0;  ///< 1: the fingers are spread; 0: they lie side by side
  float curl = 0;    ///< 1: a fist; 0: a flat hand
  /// @}
  /// Gravity in the axes of the wrist (x to the right, y out of the back, z to the arm), unit
  /// length.
  glm::vec3 gravity{0, 0, 1};
  /// The mesh that is drawn, and its vertices as they are now: camera space, m, and unit normals.
  /// Borrowed until the next moment. Vertices are empty without a hand, and if no source needs them
  /// (Needs::surface).
  /// @{
  const renderer::HandMesh* mesh = nullptr;
  std::span<const glm::vec3> positions_m, normals;
  /// @}
};

/// What the camera saw last.
struct CameraView {
  renderer::TimedImage image;
  const calib::CameraModel* lens = nullptr;  ///< never null
  /// As they were when the image was taken; never null.
  /// @{
  const HandState* hand = nullptr;   ///< that wears the content
  const HandState* other = nullptr;  ///< the person's other hand
  /// @}
};

/// What a source draws for.
struct Moment {
  double time_s = 0;                 ///< since the source was opened
  double step_s = 1.0 / 60;          ///< since its last picture
  std::uint64_t frame = 0;           ///< pictures that it has drawn before
  double progress = 0;               ///< of a transition, 0..1
  std::tm date{};                    ///< local time
  double day_s = 0;                  ///< seconds since midnight, local time
  const HandState* hand = nullptr;   ///< that wears the content; never null
  const HandState* other = nullptr;  ///< the person's other hand; never null
  /// Null if there is no image, or no source needs it (Needs::camera).
  const CameraView* camera = nullptr;
};

/// What a source uses of a moment that costs time to provide.
struct Needs {
  bool surface = false;  ///< HandState::positions_m and normals, of all hands
  bool camera = false;   ///< Moment::camera, with the surfaces of its hands

  Needs& operator|=(const Needs& other) {
    surface |= other.surface;
    camera |= other.camera;
    return *this;
  }
};

/// What can be changed while a source runs.
struct Parameter {
  enum class Kind { number, whole, flag, event, choice, point, colour, text, picture, sound };
  std::string name;
  std::string label;  ///< for people
  Kind kind = Kind::number;
  /// One number, two of a point, four of a colour (red, green, blue, alpha, 0..1); a choice is the
  /// number of its value. Empty: none is stated.
  /// @{
  std::vector<double> least, most, initial;
  /// @}
  std::vector<std::string> choices;  ///< the labels of a choice
  std::vector<double> values;        ///< the numbers that stand for them
};

/// The numbers in a text: "0.5", "true", "0.2,0.7", "#ff8800", or the label of a choice. Errors
/// (bad_config): they are not those of the parameter; a sentence that names it.
Result<std::vector<double>> numbers_of(const Parameter& parameter, std::string_view text);

/// A source of content, or a filter of it. Pictures are RGBA8 in UV space, premultiplied, row 0 at
/// the top. One thread, the same for all sources of a process.
class Source {
 public:
  virtual ~Source() = default;

  /// How many pictures it is given: 0 draws by itself, 1 is a filter, 2 is a transition (from the
  /// first to the second, by Moment::progress).
  virtual int inputs() const { return 0; }
  /// What it uses, the same as long as it is open.
  virtual Needs needs() const { return {}; }
  /// Draws into `out`, which has the size of the opening and the picture of the last call. Returns
  /// false if the picture is still the same; never for another input. Errors: bad_data (the
  /// picture is lost, the next one may come), disconnected and unavailable (open it again),
  /// bad_config (a person must change something).
  virtual Result<bool> draw(const Moment& moment,
                            std::span<const renderer::View<const std::uint32_t>> inputs,
                            renderer::Texture& out) = 0;

  /// What can be set.
  virtual std::span<const Parameter> parameters() const { return {}; }
  /// Sets one of them. Errors (bad_config): there is none of this name, or its value is of another
  /// kind or out of range.
  virtual Result<void> set(std::string_view name, std::string_view value);

  /// True if its files have changed since it was opened: it should be opened again.
  virtual bool is_stale() const { return false; }
};

/// What a source is opened with.
struct Opening {
  config::ContentElement element;  ///< its part of the chain
  /// Size of its pictures, texels.
  /// @{
  int width = 640, height = 400;
  /// @}
  /// The hands that are drawn, left and right: for their layouts. Outlive the source.
  std::array<const renderer::HandMesh*, 2> meshes{};
  Side side = Side::left;  ///< the hand that wears it
  /// Of the rig. Outlives the source; null: that of calib::reference_rig().
  const calib::Calibration* calibration = nullptr;
  /// Gives the ring of a stream of the rig ("guest.left"). Empty: there is no rig.
  ipc::OpenRing ring{};
  std::string sound = "default";  ///< ALSA's name of the device that is heard
};

/// A kind of source.
struct SourceKind {
  std::string_view name;      ///< before the colon: "film"
  std::string_view sentence;  ///< what it is, for people
  /// Opens it. Errors: bad_config, unavailable; sentences that begin with the name of the file.
  Result<std::unique_ptr<Source>> (*open)(const Opening&);
};

/// All kinds of this build.
std::span<const SourceKind> source_kinds();
/// Opens an element of a chain and sets its parameters. Errors: bad_config (no such kind, no
/// such parameter), those of the kind.
Result<std::unique_ptr<Source>> open_source(const Opening& opening);

}  // namespace handcast::content
