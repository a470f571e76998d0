// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "calib/solve/board/board.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calibrate {

/// What is measured, in this order: each step needs those before it.
enum class Step { lens, lens2, pair, screen, tracker, light };
constexpr std::array<std::string_view, 6> words_of(Step) {
  return {"lens", "lens2", "pair", "screen", "tracker", "light"};
}

/// The size of an image in pixels; 0 x 0: not said.
struct Size {
  int width_px = 0, height_px = 0;
};

/// The command line of `handcast calibrate`.
struct Options {
  std::filesystem::path rig_file;
  std::vector<Step> steps;            ///< empty: all that are left
  std::vector<std::string> settings;  ///< of --set
  calib::Board board;
  Size camera, camera2, projector;  ///< of a rig without a calibration
  std::filesystem::path folder;     ///< of the session; default: next to the rig file
  std::filesystem::path board_pdf;  ///< where the board is to be written, and nothing else is done
  double most_s = 180;              ///< how long a step, or a part of --check, may take
  bool yes = false;                 ///< starts each step without a key
  bool restart = false;             ///< forgets what was measured before
  bool check = false;               ///< measures today's error; nothing is changed
  /// Diameter of the reflector on an index finger tip; 0: the tracker is measured by a hand's
  /// landmarks.
  double reflector_mm = 0;
  std::filesystem::path points;   ///< folder of recorded points; nothing else is done
  bool correct = false;           ///< corrects a tracker that has moved while the rig is up
  bool undo = false;              ///< takes back what the last call has changed
  bool apply = false;             ///< writes measured settings to a file beside the rig file
  bool second_projector = false;  ///< measures that one in place of the first
  std::string photodiode;         ///< ALSA device with a photodiode in the light; empty: none
  std::string text{};  ///< that --help or --version asks for; "" if the program shall run
};

/// The folder of a session that was not named.
std::filesystem::path default_folder(const Options& options);
/// Whether a step measures what the call is about: of a second projector, only itself.
bool concerns(const Options& options, Step step);

/// Errors: bad_config.
Result<Options> parse(int argc, char** argv);

}  // namespace handcast::calibrate
