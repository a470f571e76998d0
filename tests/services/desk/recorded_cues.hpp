// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "services/desk/base/cue_deck.hpp"

namespace handcast::test {

/// A deck that records its commands.
class RecordedCues final : public desk::CueDeck {
 public:
  void go() override { calls.push_back("go"); }
  void back() override { calls.push_back("back"); }
  void hold() override { calls.push_back("hold"); }
  Result<void> jump(std::string_view cue) override {
    calls.push_back("jump " + std::string(cue));
    return {};
  }
  void key(std::string_view key) override { calls.push_back("key " + std::string(key)); }
  std::shared_ptr<const desk::CuePlace> place() const override { return nullptr; }

  std::vector<std::string> calls;
};

}  // namespace handcast::test
