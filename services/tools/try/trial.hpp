// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace handcast::trial {

/// What is tried.
struct Wanted {
  std::string source;  ///< as in a rig file; relative paths start at the current folder
  int width_px = 640, height_px = 400;
  int frames = 30;               ///< pictures, 1/30 s apart
  std::filesystem::path folder;  ///< of the pictures; empty: none are written
  std::string name;              ///< the beginning of their names
  bool projects = false;         ///< also write what a projector shows to put them onto the hand
  double patience_s = 30;        ///< no further picture is begun after this time
};

/// What is known about a source:
///
///     source, loaded, drawn        as given; it was opened; it has drawn, and all went well
///     pictures, plain              how many were drawn; each was of a single colour
///     motion                       "moves": the pictures differ; "reacts": they do with other
///                                  parameters; "still"; "" before the first picture
///     reacts_to                    the names of these parameters
///     open_ms, first_ms            the opening; the first picture, for which drivers compile
///     median_ms, p99_ms            the other pictures
///     error, end                   a sentence, or ""; "hang" or "crash", or ""
///     files                        the pictures that were written
///     parameters                   name, label, kind, least, most, initial, choices
using Report = nlohmann::json;

/// A report about a source before anything has happened.
Report blank_report(const std::string& source);

/// Opens a source, draws it, and, if it is still, draws it with its parameters at their least and
/// most. A filter or transition that is the lowest element gets test cards that move. `tell` is
/// given what is known after each step, and last what is returned.
Report draw_source(const Wanted& wanted, const std::function<void(const Report&)>& tell);

}  // namespace handcast::trial
