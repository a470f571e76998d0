// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tests/ipc/ring_testing.hpp"
#include "tests/supervisor/control/control_fixture.hpp"

namespace handcast::client {

/// A rig "desk" whose supervisor gives descriptors of rings, as the real one does: read-only, but
/// for the rings of guests. It answers only inside while_it_turns().
class RigWithRings : public supervisor::Control {
 protected:
  static ipc::Segment notes(const std::string& stream, int slots = 8) {
    return ipc::samples::must(
        ipc::Segment::create(ipc::RingSpec::of<ipc::samples::Note>(stream, slots, true)));
  }
  /// Lists `name` and gives the descriptor `fd`, which must stay open.
  using Rings = std::vector<std::pair<nlohmann::json, int>>;
  void give(Rings rings) {
    server_.reset();
    serve([rings = std::move(rings)](const control::Request&, const auto& reply) {
      auto answer = control::success();
      answer["rings"] = nlohmann::json::array();
      std::vector<UniqueFd> owned;
      std::vector<int> descriptors;
      for (const auto& [name, fd] : rings) {
        answer["rings"].push_back(name);
        const auto path = "/proc/self/fd/" + std::to_string(fd);
        const bool is_for_guests =
            name.is_string() && name.template get<std::string>().starts_with("guest.");
        owned.emplace_back(::open(path.c_str(), (is_for_guests ? O_RDWR : O_RDONLY) | O_CLOEXEC));
        descriptors.push_back(owned.back().get());
      }
      reply(answer, descriptors);
    });
  }
};

}  // namespace handcast::client
