// SPDX-License-Identifier: Apache-2.0
#include "services/recording/arrays/recorded_hands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>

#include "ipc/base/log.hpp"
#include "services/joints/conventions.hpp"
#include "services/joints/leap_hand.hpp"
#include "services/recording/arrays/recorded_hands_checks.hpp"

namespace handcast::recording {
namespace {

using namespace joints;
using msg::kJoints;
using std::filesystem::path;

constexpr std::array<std::string_view, 2> kSideNames{"left", "right"};
constexpr std::array<std::string_view, 3> kStampFiles{"timestamps.npy", "camera_timestamps.npy",
                                                      "landmarks_timestamps.npy"};
/// Largest gap between the last time of one sensor and the first of another: an hour.
constexpr std::int64_t kMostGap_ns = 3'600'000'000'000;
constexpr double kForearm_mm = 250;  ///< written distance of the elbow, which poses do not hold

path array_file(const path& folder, std::string_view what, std::size_t side) {
  return folder / fmt::format("{}_{}.npy", what, kSideNames[side]);
}

std::string text_of(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t extent : shape)
    text += (text.empty() ? "(" : ", ") + std::to_string(extent);
  return text + ")";
}

/// The lines of numpy that leave out the samples of a hand that was lost; the end of a sentence.
std::string left_out(const path& file) {
  const auto name = file.stem().string();
  const auto side = name.substr(name.rfind('_') + 1);
  return fmt::format(
      "; leave out the samples in which the hand was lost: j = numpy.load('joints_{0}.npy'); b = "
      "numpy.load('bones_{0}.npy'); ok = numpy.isfinite(j).all((1, 2)) & j.any((1, 2)) & "
      "numpy.isfinite(b).all((1, 2, 3)); numpy.save('joints_{0}.npy', j[ok]); "
      "numpy.save('bones_{0}.npy', b[ok]); numpy.save('timestamps.npy', "
      "numpy.load('timestamps.npy')[ok])",
      side);
}

/// The line of numpy that gives an array its shape; the end of a sentence. Empty if none can.
std::string reshaped(const path& file, const std::vector<std::size_t>& is,
                     const std::vector<std::size_t>& wanted) {
  const auto count_of = [](const auto& shape) {
    std::size_t count = 1;
    for (const auto extent : shape) count *= extent;
    return count;
  };
  if (count_of(is) != count_of(wanted)) return {};
  const auto name = file.filename().string();
  const bool ends_with_samples = is.size() == wanted.size() && is.back() == wanted.front();
  return fmt::format("; in Python, numpy.save('{0}', {1})", name,
                     ends_with_samples
                         ? fmt::format("numpy.moveaxis(numpy.load('{}'), -1, 0).copy()", name)
                         : fmt::format("numpy.load('{}').reshape{}", name, text_of(wanted)));
}

/// An array of samples without a number that is not finite.
Result<Npy> read_shaped(const path& file, const std::vector<std::size_t>& shape) {
  auto opened = NpyFile::open(file);
  if (!opened) return tl::make_unexpected(opened.error());
  if (opened->shape() != shape)
    return fail(Errc::bad_data, fmt::format("{}: the array has shape {}, but must have shape {}{}",
                                            file.string(), text_of(opened->shape()), text_of(shape),
                                            reshaped(file, opened->shape(), shape)));
  auto array = opened->read();
  if (!array) return array;
  const auto odd =
      std::ranges::find_if_not(array->values, [](double v) { return std::isfinite(v); });
  if (odd == array->values.end()) return array;
  const auto of_a_sample = static_cast<std::ptrdiff_t>(array->values.size() / shape.front());
  return fail(Errc::bad_data,
              fmt::format("{}: sample {} has a number that is not finite{}", file.string(),
                          (odd - array->values.begin()) / of_a_sample, left_out(file)));
}

Result<void> remove_file(const path& file) {
  std::error_code failed;
  std::filesystem::remove(file, failed);
  if (failed)
    return fail(Errc::unavailable,
                fmt::format("{}: cannot be removed: {}", file.string(), failed.message()));
  return {};
}

/// A hand of a recording. The first two rows of a bone point to its tip and out of the palm.
Result<msg::HandPose> pose_of(msg::Side side, const double* joint_mm, const double* bones,
                              const std::array<float, kJoints>& radius_m) {
  joints::LeapHand hand{.side = side};
  for (int bone = 0; bone < kLeapBones; ++bone) {
    const double* rows = bones + 16 * bone;
    const auto axes =
        joints::axes_of_bone({rows[0], rows[1], rows[2]}, {rows[4], rows[5], rows[6]});
    if (!axes && std::ranges::find(kLeapBone, bone) != kLeapBone.end())
      return fail(Errc::bad_data, "a bone without axes");
    hand.axes[bone] = axes.value_or(glm::dquat(1, 0, 0, 0));
  }
  for (int joint = 0; joint < kLeapJoints; ++joint)
    hand.joint_mm[joint] = {joint_mm[3 * joint], joint_mm[3 * joint + 1], joint_mm[3 * joint + 2]};
  auto pose = joints::rig_hand(hand);
  for (int j = 0; j < kJoints; ++j) pose.joints[j].radius_m = radius_m[j];
  return pose;
}

Result<std::vector<msg::HandPose>> read_hand(const path& folder, std::size_t side,
                                             std::span<const std::int64_t> time_ns) {
  const std::size_t samples = time_ns.size();
  const auto joints = read_shaped(array_file(folder, "joints", side), {samples, kLeapJoints, 3});
  if (!joints) return tl::make_unexpected(joints.error());
  const auto bones = read_shaped(array_file(folder, "bones", side), {samples, kLeapBones, 4, 4});
  if (!bones) return tl::make_unexpected(bones.error());

  std::vector<msg::HandPose> poses;
  for (std::size_t i = 0; i < samples; ++i) {
    auto pose = pose_of(static_cast<msg::Side>(side), &joints->values[i * kLeapJoints * 3],
                        &bones->values[i * kLeapBones * 16], joints::kMeanRadii_m);
    if (!pose)
      return fail(Errc::bad_data,
                  fmt::format("{}: sample {} has {}{}", array_file(folder, "bones", side).string(),
                              i, pose.error().what, left_out(array_file(folder, "bones", side))));
    poses.push_back(*pose);
  }
  if (const auto fault = fault_of_poses(poses, time_ns); !fault.empty())
    return fail(Errc::bad_data,
                fmt::format("{}: {}", array_file(folder, "joints", side).string(), fault));
  return poses;
}

struct LeapArrays {
  std::vector<float> joints, bones;

  explicit LeapArrays(std::size_t samples)
      : joints(samples * kLeapJoints * 3), bones(samples * kLeapBones * 16) {}

  void set_joint(std::size_t sample, int joint, const glm::dvec3& place_mm) {
    for (int c = 0; c < 3; ++c)
      joints[(sample * kLeapJoints + joint) * 3 + c] = static_cast<float>(place_mm[c]);
  }
  void set_bone(std::size_t sample, int bone, const glm::dmat3& axes, const glm::dvec3& origin_mm) {
    float* b = &bones[(sample * kLeapBones + bone) * 16];
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) b[4 * row + c] = static_cast<float>(-10 * axes[2 - row][c]);
    for (int c = 0; c < 3; ++c) b[12 + c] = static_cast<float>(origin_mm[c]);
    b[15] = 1;
  }
};

void put(LeapArrays& arrays, std::size_t sample, const msg::HandPose& pose) {
  std::array<glm::dvec3, kJoints> place_mm;
  std::array<glm::dmat3, kJoints> axes;
  for (int j = 0; j < kJoints; ++j) {
    const auto& joint = pose.joints[j];
    const auto& q = joint.orientation_xyzw;
    place_mm[j] = glm::dvec3(joint.position_m[0], joint.position_m[1], joint.position_m[2]) * 1e3;
    axes[j] = glm::mat3_cast(glm::normalize(glm::dquat(q[3], q[0], q[1], q[2])));
  }
  arrays.set_joint(sample, 0, place_mm[kWrist] + axes[kWrist][2] * kForearm_mm);
  arrays.set_bone(sample, 0, axes[kWrist], place_mm[kWrist]);
  arrays.set_bone(sample, 1, axes[kWrist], place_mm[kWrist] + axes[kWrist][2] * (kForearm_mm / 2));
  arrays.set_joint(sample, 2, place_mm[2]);
  arrays.set_bone(sample, 2, axes[2], place_mm[2]);
  for (int j = kWrist; j < kJoints; ++j) {
    arrays.set_joint(sample, kLeapJoint[j], place_mm[j]);
    const bool starts_a_bone = kLeapBone[j] != kLeapBone[j - 1];
    if (!starts_a_bone) continue;
    arrays.set_bone(sample, kLeapBone[j], axes[j], place_mm[j]);
    const bool ends_a_bone_too = kLeapJoint[j] % 2 == 1;
    if (ends_a_bone_too) arrays.set_joint(sample, kLeapJoint[j] + 1, place_mm[j]);
  }
}

}  // namespace

Result<bool> is_there(const path& file) {
  std::error_code failed;
  const bool there = std::filesystem::exists(file, failed);
  if (failed)
    return fail(Errc::bad_config, fmt::format("cannot tell whether '{}' exists: {}", file.string(),
                                              failed.message()));
  return there;
}

namespace {

/// As read_stamps_ns(), but times may be equal.
Result<std::vector<std::int64_t>> read_rising_ns(const path& file) {
  constexpr std::size_t kMostStamps = 10'000'000;  // 80 MB
  auto opened = NpyFile::open(file);
  if (!opened) return tl::make_unexpected(opened.error());
  if (opened->count() > kMostStamps)
    return fail(Errc::bad_data, fmt::format("{}: has {} times; at most {} are read", file.string(),
                                            opened->count(), kMostStamps));
  const auto array = opened->read();
  if (!array) return tl::make_unexpected(array.error());
  if (const auto fault = fault_of_times(array->values); !fault.empty())
    return fail(Errc::bad_data, fmt::format("{}: {}", file.string(), fault));
  std::vector<std::int64_t> times_ns;
  for (const double time_us : array->values) {
    const double whole_us = std::floor(time_us);
    const std::int64_t time_ns =
        static_cast<std::int64_t>(whole_us) * 1000 + std::llround((time_us - whole_us) * 1e3);
    if (!times_ns.empty() && time_ns < times_ns.back())
      return fail(Errc::bad_data, fmt::format("{}: time {} is not later than the one before it",
                                              file.string(), times_ns.size()));
    times_ns.push_back(time_ns);
  }
  return times_ns;
}

/// Leaves out the samples that have the time of the one before. Returns how many.
std::size_t drop_repeated(RecordedHands& recording) {
  std::vector<std::int64_t> times_ns;
  std::array<std::vector<msg::HandPose>, 2> hands;
  for (std::size_t i = 0; i < recording.time_ns.size(); ++i) {
    if (!times_ns.empty() && recording.time_ns[i] == times_ns.back()) continue;
    times_ns.push_back(recording.time_ns[i]);
    for (std::size_t side = 0; side < hands.size(); ++side)
      if (!recording.hands[side].empty()) hands[side].push_back(recording.hands[side][i]);
  }
  const auto dropped = recording.time_ns.size() - times_ns.size();
  recording.time_ns = std::move(times_ns);
  recording.hands = std::move(hands);
  return dropped;
}

}  // namespace

Result<std::vector<std::int64_t>> read_stamps_ns(const path& file) {
  auto times_ns = read_rising_ns(file);
  if (!times_ns) return times_ns;
  const auto again = std::ranges::adjacent_find(*times_ns);
  if (again != times_ns->end())
    return fail(Errc::bad_data, fmt::format("{}: time {} is not later than the one before it",
                                            file.string(), again - times_ns->begin() + 1));
  return times_ns;
}

Result<std::vector<std::vector<std::int64_t>>> read_all_stamps_ns(const path& folder) {
  std::vector<std::vector<std::int64_t>> all_ns;
  for (const auto name : kStampFiles) {
    const auto there = is_there(folder / name);
    if (!there) return tl::make_unexpected(there.error());
    if (!*there) continue;
    auto times_ns = read_rising_ns(folder / name);
    if (!times_ns) return tl::make_unexpected(times_ns.error());
    times_ns->erase(std::unique(times_ns->begin(), times_ns->end()), times_ns->end());
    for (const auto& other_ns : all_ns)
      if (!times_ns->empty() && std::max(times_ns->front() - other_ns.back(),
                                         other_ns.front() - times_ns->back()) > kMostGap_ns)
        return fail(Errc::bad_config,
                    fmt::format("{}: its times are more than an hour from those of the recording's "
                                "other sensors; all must be of one clock",
                                (folder / name).string()));
    if (!times_ns->empty()) all_ns.push_back(std::move(*times_ns));
  }
  return all_ns;
}

Result<void> remove_recording(const path& folder) {
  for (const auto name : kStampFiles)
    if (auto removed = remove_file(folder / name); !removed) return removed;
  for (const auto what : {"joints", "bones", "landmarks"})
    for (std::size_t side = 0; side < 2; ++side)
      if (auto removed = remove_file(array_file(folder, what, side)); !removed) return removed;
  return {};
}

Result<RecordedHands> read_recording(const path& folder) {
  constexpr std::size_t kMostPoses = 100'000;  // those of two hands take 800 MB
  const path stamps = folder / "timestamps.npy";
  auto times_ns = read_rising_ns(stamps);
  if (!times_ns) return tl::make_unexpected(times_ns.error());
  if (times_ns->size() < 2)
    return fail(Errc::bad_data,
                fmt::format("{}: a recording needs at least two times", stamps.string()));
  if (times_ns->size() > kMostPoses)
    return fail(Errc::bad_data, fmt::format("{}: has {} poses; at most {} are read",
                                            stamps.string(), times_ns->size(), kMostPoses));
  RecordedHands recording;
  recording.first_ns = times_ns->front();
  recording.time_ns = std::move(*times_ns);
  for (auto& time_ns : recording.time_ns) time_ns -= recording.first_ns;
  bool any = false;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto there = is_there(array_file(folder, "joints", side));
    if (!there) return tl::make_unexpected(there.error());
    if (!*there) continue;
    auto hand = read_hand(folder, side, recording.time_ns);
    if (!hand) return tl::make_unexpected(hand.error());
    recording.hands[side] = std::move(*hand);
    any = true;
  }
  if (!any)
    return fail(
        Errc::bad_config,
        fmt::format("{}: there is neither joints_left.npy nor joints_right.npy", folder.string()));
  if (const auto dropped = drop_repeated(recording); dropped > 0)
    log::warning("{}: {} of {} samples have the time of the one before; they are left out",
                 stamps.string(), dropped, recording.time_ns.size() + dropped);
  return recording;
}

Result<void> write_recording(const path& folder, const RecordedHands& recording) {
  std::error_code made;
  std::filesystem::create_directories(folder, made);
  if (made)
    return fail(Errc::unavailable,
                fmt::format("{}: cannot be created: {}", folder.string(), made.message()));

  const std::size_t samples = recording.time_ns.size();
  std::vector<std::int64_t> time_us;
  for (const std::int64_t ns : recording.time_ns)
    time_us.push_back((recording.first_ns + ns + 500) / 1000);
  if (auto written = write_npy_i64(folder / "timestamps.npy", time_us); !written) return written;
  for (std::size_t side = 0; side < 2; ++side) {
    if (recording.hands[side].empty()) {
      for (const auto what : {"joints", "bones"})
        if (auto removed = remove_file(array_file(folder, what, side)); !removed) return removed;
      continue;
    }
    if (recording.hands[side].size() != samples)
      return fail(Errc::bad_data,
                  fmt::format("{}: the recording has {} poses for {} times", folder.string(),
                              recording.hands[side].size(), samples));
    LeapArrays arrays(samples);
    for (std::size_t i = 0; i < samples; ++i) put(arrays, i, recording.hands[side][i]);
    auto joints =
        write_npy_f32(array_file(folder, "joints", side), {samples, kLeapJoints, 3}, arrays.joints);
    if (!joints) return joints;
    auto bones =
        write_npy_f32(array_file(folder, "bones", side), {samples, kLeapBones, 4, 4}, arrays.bones);
    if (!bones) return bones;
  }
  return {};
}

}  // namespace handcast::recording
