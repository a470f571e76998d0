// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/rung_mover.hpp"

#include <array>

#include "renderer/base/clones.hpp"

namespace handcast::renderer {
namespace {

/// The finger of a joint, thumb 0; -1 for palm, wrist and the metacarpals of the four fingers.
int finger_of_joint(int joint) {
  constexpr int kThumb = 2, kIndex = 6, kJointsOfFinger = 5;
  if (joint < kThumb) return -1;
  if (joint < kIndex) return 0;
  return (joint - kIndex) % kJointsOfFinger == 0 ? -1 : 1 + (joint - kIndex) / kJointsOfFinger;
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

/// `share`: `count` numbers per finger, finger after finger; `shift`: x y of each finger.
HANDCAST_CLONES void add_fingers(const float* share, const float* shift, float* xy, int count) {
  const float *a = share, *b = a + count, *c = b + count, *d = c + count, *e = d + count;
  for (int v = 0; v < count; ++v) {
    xy[2 * v] +=
        a[v] * shift[0] + b[v] * shift[2] + c[v] * shift[4] + d[v] * shift[6] + e[v] * shift[8];
    xy[2 * v + 1] +=
        a[v] * shift[1] + b[v] * shift[3] + c[v] * shift[5] + d[v] * shift[7] + e[v] * shift[9];
  }
}

}  // namespace

RungMover::RungMover(const HandMesh& mesh) : share_(kFingers * mesh.vertex_count()) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    for (int k = 0; k < 4; ++k) {
      const int finger = finger_of_joint(mesh.joints[v][k]);
      if (finger >= 0)
        share_[static_cast<std::size_t>(finger) * mesh.vertex_count() + v] += mesh.weights[v][k];
    }
}

void RungMover::move(const RungModel& model, std::span<glm::vec2> vertices) const {
  if (vertices.empty()) return;
  const auto count = static_cast<int>(vertices.size());
  const std::array whole{model.whole.cosine, model.whole.sine, model.whole.shift.x,
                         model.whole.shift.y};
  move_wholly(whole.data(), &vertices[0].x, count);
  if (model.fingers != decltype(model.fingers){})
    add_fingers(share_.data(), &model.fingers[0].x, &vertices[0].x, count);
}

}  // namespace handcast::renderer
