// SPDX-License-Identifier: Apache-2.0
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "renderer/hand/mesh_charts.hpp"
#include "renderer/skin/skinning.hpp"
#include "services/lab/hand_maker/cotangent.hpp"
#include "services/lab/hand_maker/glove_fit.hpp"
#include "services/lab/hand_maker/unwrap.hpp"

namespace handcast::renderer {
namespace {

/// The skin weights of one vertex.
struct VertexWeights {
  std::array<std::uint8_t, 4> joints{};  ///< XR joints, in descending order of weight
  std::array<float, 4> weights{};        ///< sum to 1; 0 if unused
};

constexpr int kWrist = 1;
constexpr double kLeastWeight = 0.01;  ///< smaller weights are dropped

double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a;
  const double share = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::distance(p, a + ab * share);
}

/// The bone, given by the joint at its start, to which a vertex belongs: for palm vertices the
/// forearm, a metacarpal or the proximal phalanx of a finger other than the thumb; for finger
/// vertices a bone of their own finger.
int nearest_bone(const glm::dvec3& p, int finger_of_vertex, const RestPose& rest) {
  constexpr double kMetacarpalHandicap = 2;  // mm: favours the phalanges for the skin of a finger
  const bool in_palm = finger_of_vertex < 0;
  int best = kWrist;
  double least = in_palm ? distance_to_segment(p, {0, 0, -4}, {0, 0, 1000})
                         : std::numeric_limits<double>::max();
  for (int f = 0; f < kFingers; ++f) {
    if (!in_palm && f != finger_of_vertex) continue;
    const int last_bone =
        in_palm ? std::min(kMetacarpal[f] + (f == 0 ? 0 : 1), tip_of(f) - 1) : tip_of(f) - 1;
    for (int joint = kMetacarpal[f]; joint <= last_bone; ++joint) {
      double distance =
          distance_to_segment(p, rest.position_mm[joint], rest.position_mm[joint + 1]);
      if (!in_palm && f > 0 && joint == kMetacarpal[f]) distance += kMetacarpalHandicap;
      if (distance < least) least = distance, best = joint;
    }
  }
  return best;
}

/// Diffuses `columns` by two implicit heat steps over a distance of about `reach_mm`.
Eigen::MatrixXd spread(const MeshOperators& operators, const Eigen::MatrixXd& columns,
                       double reach_mm) {
  Eigen::SparseMatrix<double> system = operators.laplacian * (reach_mm * reach_mm / 2);
  system.diagonal() += operators.area;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  Eigen::MatrixXd spread = columns;
  for (int step = 0; step < 2; ++step)
    spread = solver.solve(operators.area.asDiagonal() * spread).eval();
  return spread;
}

VertexWeights best_four(const Eigen::RowVectorXd& row) {
  std::array<int, kJoints> order;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return row[a] > row[b]; });
  VertexWeights best;
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    if (row[order[k]] < kLeastWeight) break;
    best.joints[k] = static_cast<std::uint8_t>(order[k]);
    sum += best.weights[k] = static_cast<float>(row[order[k]]);
  }
  for (float& weight : best.weights) weight /= sum;
  return best;
}

/// The skin weights of the glued vertices. Each vertex belongs to the nearest bone of its part of
/// the hand. The weights are diffused over the skin by two implicit heat steps, further in the palm
/// than on the fingers, and reduced to the four largest.
std::vector<VertexWeights> skin_weights(const SkinPoints& points,
                                        const std::vector<Triangle>& triangles,
                                        const GloveTemplate& glove, const RestPose& rest) {
  constexpr double kFingerReach = 3.2, kPalmReach = 8, kChangeover = 4;  // mm
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd bone = Eigen::MatrixXd::Zero(count, kJoints),
                  in_palm = Eigen::MatrixXd::Zero(count, 1);
  for (int v = 0; v < count; ++v) {
    const int finger = glove.sheet()[glove.sheet_of_glued(v)].finger;
    bone(v, nearest_bone(points[v], finger, rest)) = 1;
    in_palm(v, 0) = finger < 0 ? 1 : 0;
  }
  const MeshOperators operators = mesh_operators(points, triangles);
  const Eigen::ArrayXd palm_share = spread(operators, in_palm, kChangeover).col(0).array();
  const Eigen::MatrixXd narrow = spread(operators, bone, kFingerReach),
                        wide = spread(operators, bone, kPalmReach);
  std::vector<VertexWeights> weights;
  for (Eigen::Index v = 0; v < count; ++v)
    weights.push_back(best_four(narrow.row(v) * (1 - palm_share[v]) + wide.row(v) * palm_share[v]));
  return weights;
}

constexpr int kRoundsFromScratch = 90, kRoundsOfARefit = 30;

const GloveTemplate& glove_template() {
  static const GloveTemplate glove;
  return glove;
}

std::vector<Triangle> glued_triangles(const GloveTemplate& glove, const std::vector<Triangle>& back,
                                      const std::vector<Triangle>& palm) {
  std::vector<Triangle> glued = back;
  for (const Triangle& t : palm)
    glued.push_back(
        {glove.glued_on_palm(t[0]), glove.glued_on_palm(t[1]), glove.glued_on_palm(t[2])});
  return glued;
}

void set_triangles(HandMesh& hand, const GloveTemplate& glove, const std::vector<Triangle>& back,
                   const std::vector<Triangle>& palm) {
  const auto add = [&](const Triangle& t, int first) {
    hand.triangles.push_back({static_cast<std::uint16_t>(first + t[0]),
                              static_cast<std::uint16_t>(first + t[1]),
                              static_cast<std::uint16_t>(first + t[2])});
  };
  for (const Triangle& t : back) add(t, 0);
  for (const Triangle& t : palm) add(t, glove.sheet_count());
}

/// Sets the positions (metres) and normals of the file vertices, and the joints.
void set_skin(HandMesh& hand, const GloveTemplate& glove, const HandShape& shape,
              const SkinPoints& points, const HandField& field) {
  hand.positions.clear();
  hand.normals.clear();
  for (int v = 0; v < glove.file_count(); ++v) {
    const glm::dvec3& point = points[glove.glued_of_file(v)];
    hand.positions.emplace_back(point * 1e-3);
    hand.normals.emplace_back(field.normal(point));
  }
  hand.rest = rest_frames(shape);
}

void set_weights(HandMesh& hand, const GloveTemplate& glove,
                 const std::vector<VertexWeights>& weights) {
  for (int v = 0; v < glove.file_count(); ++v) {
    const VertexWeights& w = weights[glove.glued_of_file(v)];
    hand.joints.push_back(w.joints);
    hand.weights.push_back(w.weights);
  }
}

/// Turns a left hand into a right one or vice versa: mirrors x (orientations S R S) and reverses
/// the triangles.
void mirror(HandMesh& hand) {
  const glm::mat4 flip(glm::vec4(-1, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 0),
                       glm::vec4(0, 0, 0, 1));
  for (glm::vec3& p : hand.positions) p.x = -p.x;
  for (glm::vec3& n : hand.normals) n.x = -n.x;
  for (glm::mat4& rest : hand.rest) rest = flip * rest * flip;
  for (auto& t : hand.triangles) std::swap(t[1], t[2]);
  hand.side = hand.side == Side::left ? Side::right : Side::left;
}

/// The skin of the mean hand, posed by the joints of another person and stretched along each bone
/// by the ratio of the lengths.
SkinPoints carried_skin(const HandMesh& mean, const GloveTemplate& glove, const HandShape& shape) {
  JointFrames frames = rest_frames(shape);
  const JointFrames unstretched = frames;
  for (int j = 0; j < kJoints; ++j)
    if (const int bone = kJointParent[j]; bone > 1)
      frames[bone][2] *= glm::distance(unstretched[j][3], unstretched[bone][3]) /
                         glm::distance(mean.rest[j][3], mean.rest[bone][3]);
  std::vector<glm::vec3> carried(mean.vertex_count());
  skin(mean, frames, carried);
  SkinPoints points(glove.glued_count());
  for (int v = 0; v < glove.file_count(); ++v)
    points[glove.glued_of_file(v)] = glm::dvec3(carried[v]) * 1e3;
  return points;
}

}  // namespace

HandMesh make_hand(const HandShape& shape, Side side) {
  const GloveTemplate& glove = glove_template();
  const RestPose rest = rest_pose(shape);
  const HandField field(shape, rest);
  const GloveLayout layout = lay_out_glove(glove, shape, rest);
  SkinPoints points = place_on_skin(glove, layout, field);
  relax_on_skin(points, glove, layout, field, kRoundsFromScratch);
  const auto back = glove.triangulated(points, true), palm = glove.triangulated(points, false);

  HandMesh hand;
  hand.side = Side::left;
  set_triangles(hand, glove, back, palm);
  set_skin(hand, glove, shape, points, field);
  set_weights(hand, glove, skin_weights(points, glued_triangles(glove, back, palm), glove, rest));
  hand.uv = unwrapped(points, glove, back, palm);
  number_charts(hand);
  if (side == Side::right) {
    mirror(hand);
    for (glm::vec2& uv : hand.uv) uv.x = 1 - uv.x;  // text must not be mirrored on this hand
  }
  return hand;
}

HandMesh refit_hand(const HandMesh& mean, const HandShape& shape) {
  const GloveTemplate& glove = glove_template();
  HandMesh hand = mean;
  if (mean.side == Side::right) mirror(hand);
  if (hand.vertex_count() == static_cast<std::size_t>(glove.file_count())) {
    const HandField field(shape, rest_pose(shape));
    const SkinPoints points =
        settled_on_skin(carried_skin(hand, glove, shape), glove, field, kRoundsOfARefit);
    set_skin(hand, glove, shape, points, field);
  } else {  // not made by make_hand(): its skin can only follow the joints
    skin(HandMesh(hand), rest_frames(shape), hand.positions, hand.normals);
    hand.rest = rest_frames(shape);
  }
  if (mean.side == Side::right) mirror(hand);
  return hand;
}

}  // namespace handcast::renderer
