// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include "services/lab/hand_maker/glb_write.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"

// handcast-make-hands FOLDER: writes hand_left.glb and hand_right.glb of the mean person. The build
// runs it.
int main(int argc, char** argv) {
  using namespace handcast::renderer;
  if (argc != 2) return std::fprintf(stderr, "usage: handcast-make-hands FOLDER\n"), 2;
  const std::filesystem::path folder = argv[1];
  std::error_code error;
  if (std::filesystem::create_directories(folder, error); error) {
    std::fprintf(stderr, "handcast-make-hands: %s cannot be created: %s\n", folder.c_str(),
                 error.message().c_str());
    return 1;
  }
  for (const Side side : {Side::left, Side::right}) {
    const auto file = folder / (side == Side::left ? "hand_left.glb" : "hand_right.glb");
    if (const auto saved = save_hand(make_hand(HandShape::mean(), side), file); !saved) {
      std::fprintf(stderr, "handcast-make-hands: %s\n", saved.error().what.c_str());
      return 1;
    }
  }
  return 0;
}
