// SPDX-License-Identifier: Apache-2.0
#include "services/joints/conventions.hpp"

#include <string_view>

namespace handcast::joints {
namespace {

std::string_view words_of(Place place) {
  switch (place) {
    case Place::bones:
      return "its joints lie in the middle of the limbs, its tips at the ends of the bones";
    case Place::model:
      return "its joints are those of handcast's hand model, its tips on the skin";
    case Place::as_recorded:
      return "its joints are those of the recording";
    case Place::as_sent:
      return "its joints are those that a program sends";
    case Place::unknown:
      break;
  }
  return "it does not say where its joints lie";
}

std::string_view words_of(Radii radii) {
  switch (radii) {
    case Radii::bone_widths:
      return "the flesh has the widths of its bones";
    case Radii::model:
      return "the flesh has the widths of the model";
    case Radii::as_recorded:
      return "the flesh is as recorded";
    case Radii::as_sent:
      return "the flesh is as sent";
    case Radii::none:
      break;
  }
  return "it knows no widths of the flesh";
}

}  // namespace

std::string sentence_of(const Conventions& conventions) {
  std::string sentence(words_of(conventions.place));
  if (!conventions.has_measured_palm) sentence += "; the palm is half-way along a metacarpal";
  if (!conventions.has_metacarpals) sentence += "; the metacarpals are guessed";
  if (!conventions.has_measured_axes) sentence += "; the axes follow from the positions";
  return sentence + "; " + std::string(words_of(conventions.radii));
}

}  // namespace handcast::joints
