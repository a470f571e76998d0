// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/daemon/attached.hpp"

namespace handcast::devices {

using daemon::Attached;
using daemon::Kind;
using daemon::kKindNames;
using daemon::Mode;
using daemon::Search;
using daemon::to_json;

/// The devices of one kind of driver. A driver that is not in this build has none.
/// @{
std::vector<Attached> webcams();
std::vector<Attached> monitors();     ///< of the window system, for the output `window`
std::vector<Attached> connectors();   ///< of the graphics cards, for the output `kms`
std::vector<Attached> controllers();  ///< of DLP projectors
/// @}

/// The cameras that handcast-camera finds by its back ends that are files; with a name, by that one
/// alone. Takes a second.
std::vector<Attached> cameras_of_files(const Search& search = {}, const std::string& file = {});

/// All devices of a kind.
std::vector<Attached> attached_of(Kind kind);
/// Whatever is attached.
std::vector<Attached> all_attached();

/// What this installation cannot see, a phrase each.
std::vector<std::string> blind_spots();

/// The kinds of trackers that are not attached, a sentence each.
std::vector<std::string> missing_trackers();

/// The list for people, with what to paste into a rig file.
std::string print(const std::vector<Attached>& attached,
                  const std::vector<std::string>& blind_spots,
                  const std::vector<std::string>& missing_trackers = {});

}  // namespace handcast::devices
