#include "renderer/cascade/rung.hpp"

#include <algorithm>

#include "renderer/clones.hpp"

namespace handcast::renderer {
namespace {

constexpr int kFingers = 5;
constexpr std::array<int, kRungs> kFreeNumbers{0, 0, 2, 4, 4 + 2 * kFingers, 2 * kLandmarks, 2 * kLandmarks};

/// Landmarks 4 f + 1 to 4 f + 4 are finger f's; the wrist's is nobody's: -1.
constexpr int finger_of_landmark(int landmark) { return (landmark + 3) / 4 - 1; }

/// The joints from the knuckle on; palm, wrist and the metacarpals of the four fingers belong to no finger.
int finger_of_joint(int joint) {
  constexpr int kThumb = 2, kIndex = 6, kJointsOfFinger = 5;
  if (joint < kThumb) return -1;
  if (joint < kIndex) return 0;
  return (joint - kIndex) % kJointsOfFinger == 0 ? -1 : 1 + (joint - kIndex) / kJointsOfFinger;
}

glm::vec2 mean_shift(const LandmarkPoints& p, const LandmarkPoints& q) {
  glm::vec2 sum{0};
  for (int i = 0; i < kLandmarks; ++i) sum += q[i] - p[i];
  return sum / static_cast<float>(kLandmarks);
}

/// `xy`: x y x y ...; `m`: cosine, sine, shift x, shift y.
HANDCAST_CLONES void move_wholly(const float* m, float* xy, int count) {
  const float cosine = m[0], sine = m[1], shift_x = m[2], shift_y = m[3];
  for (int v = 0; v < count; ++v) {
    const float x = xy[2 * v], y = xy[2 * v + 1];
    xy[2 * v] = cosine * x - sine * y + shift_x;
    xy[2 * v + 1] = sine * x + cosine * y + shift_y;
  }
}

/// `share`: `count` numbers of the first finger, of the second, ...; `shift`: x y of each finger.
HANDCAST_CLONES void add_fingers(const float* share, const float* shift, float* xy, int count) {
  const float *a = share, *b = a + count, *c = b + count, *d = c + count, *e = d + count;
  for (int v = 0; v < count; ++v) {
    xy[2 * v] += a[v] * shift[0] + b[v] * shift[2] + c[v] * shift[4] + d[v] * shift[6] + e[v] * shift[8];
    xy[2 * v + 1] += a[v] * shift[1] + b[v] * shift[3] + c[v] * shift[5] + d[v] * shift[7] + e[v] * shift[9];
  }
}

}  // namespace

Rung rung_named(std::string_view name) {
  const auto found = std::ranges::find(msg::kRungNames, name);
  return found == msg::kRungNames.end() ? Rung::landmarks : static_cast<Rung>(found - msg::kRungNames.begin());
}

int degrees_of_freedom(Rung rung) { return kFreeNumbers[static_cast<std::size_t>(rung)]; }

glm::vec2 RungModel::moved(int landmark, const glm::vec2& at) const {
  const int finger = finger_of_landmark(landmark);
  return finger < 0 ? whole(at) : whole(at) + fingers[finger];
}

LandmarkPoints RungModel::moved(const LandmarkPoints& p) const {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = moved(i, p[i]);
  return points;
}

RungModel fit_rung(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q) {
  RungModel model;
  if (rung == Rung::shift) model.whole.shift = mean_shift(p, q);
  if (rung > Rung::shift) model.whole = fit_similarity(p, q);
  if (rung < Rung::fingers) return model;
  constexpr float kShare = 0.25f;  // four landmarks a finger
  for (int i = 1; i < kLandmarks; ++i) model.fingers[finger_of_landmark(i)] += kShare * (q[i] - model.whole(p[i]));
  return model;
}

float residual_px2(const RungModel& model, const LandmarkPoints& p, const LandmarkPoints& q) {
  float sum = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 off = q[i] - model.moved(i, p[i]);
    sum += glm::dot(off, off);
  }
  return sum / static_cast<float>(kLandmarks);
}

RungMover::RungMover(const HandMesh& mesh) : share_(kFingers * mesh.vertex_count()) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    for (int k = 0; k < 4; ++k) {
      const int finger = finger_of_joint(mesh.joints[v][k]);
      if (finger >= 0) share_[static_cast<std::size_t>(finger) * mesh.vertex_count() + v] += mesh.weights[v][k];
    }
}

void RungMover::move(const RungModel& model, std::span<glm::vec2> vertices) const {
  if (vertices.empty()) return;
  const auto count = static_cast<int>(vertices.size());
  const std::array whole{model.whole.cosine, model.whole.sine, model.whole.shift.x, model.whole.shift.y};
  move_wholly(whole.data(), &vertices[0].x, count);
  if (model.fingers != decltype(model.fingers){}) add_fingers(share_.data(), &model.fingers[0].x, &vertices[0].x, count);
}

}  // namespace handcast::renderer
