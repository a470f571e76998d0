// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/training/film.hpp"
#include "services/lab/training/scene.hpp"

namespace handcast::landmarks::training {

/// Makes training images: synthetic infrared crops of right hands, labelled with the places of the
/// joints. The image depends on the seed and its number alone. One thread.
class Generator {
 public:
  /// Draws `people` different hands. Errors: the hand model cannot be read.
  static Result<Generator> create(int people, std::uint64_t seed);

  /// Image `number`; valid until the next call.
  const Sample& make(std::uint64_t number);

 private:
  Generator(std::vector<Person> people, std::uint64_t seed)
      : people_(std::move(people)), seed_(seed) {}

  const Person& pick_person(Dice& dice) const {
    return people_[static_cast<std::size_t>(dice.pick(static_cast<int>(people_.size())))];
  }
  void make_hand(Dice& dice);
  void make_other(Dice& dice);
  void add_other_hand(Dice& dice, const renderer::JointFrames& first, const Light& light);
  void finish(Dice& dice);

  std::vector<Person> people_;
  std::uint64_t seed_;
  calib::CameraModel camera_;
  Scene scene_{camera_, Region{{0, 0}, 1, 0}};
  Film film_;
  std::vector<std::uint8_t> pixels_;
  Sample sample_;
};

}  // namespace handcast::landmarks::training
