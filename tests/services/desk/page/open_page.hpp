// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <charconv>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "ipc/control/desk_address.hpp"
#include "services/desk/page/page.hpp"
#include "tests/scratch.hpp"
#include "tests/services/desk/page/http_client.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::test {

/// A cue list in memory.
class TableCues final : public desk::CueDeck {
 public:
  void go() override { move(place()->next); }
  void back() override { move(place()->current - 1); }
  void hold() override {
    auto place = *this->place();
    place.is_held = !place.is_held;
    put(place);
  }
  Result<void> jump(std::string_view cue) override {
    int number = 0;
    std::from_chars(cue.data(), cue.data() + cue.size(), number);
    if (number < 1 || number > static_cast<int>(place()->names.size()))
      return fail(Errc::bad_config, "there is no cue '" + std::string(cue) + "'");
    move(number - 1);
    return {};
  }
  void key(std::string_view) override {}
  std::shared_ptr<const desk::CuePlace> place() const override {
    const std::lock_guard lock(mutex_);
    return place_;
  }

 private:
  void put(desk::CuePlace place) {
    const std::lock_guard lock(mutex_);
    place_ = std::make_shared<const desk::CuePlace>(std::move(place));
  }
  void move(int to) {
    auto place = *this->place();
    if (to < 0 || to >= static_cast<int>(place.names.size())) return;
    place.current = to;
    place.next = to + 1;
    put(place);
  }

  mutable std::mutex mutex_;
  std::shared_ptr<const desk::CuePlace> place_ =
      std::make_shared<const desk::CuePlace>(desk::CuePlace{
          .names = {"Doors", "Empty hands", "First light", "Water", "Skeleton", "Fire", "Out"}});
};

/// A MIDI controller with a knob that is moved by bind().
class TableMidi final : public desk::MidiLearner {
 public:
  Result<void> learn(std::string_view path) override {
    const std::lock_guard lock(mutex_);
    if (path == "no.such") return fail(Errc::bad_config, "there is no setting 'no.such'");
    state_.learning = path;
    return {};
  }
  void stop_learning() override {
    const std::lock_guard lock(mutex_);
    state_.learning.clear();
  }
  void forget(std::string_view path) override {
    const std::lock_guard lock(mutex_);
    std::erase_if(state_.bindings, [&](const auto& binding) { return binding.first == path; });
  }
  desk::MidiState state() const override {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  /// Somebody moves a knob.
  void bind() {
    const std::lock_guard lock(mutex_);
    if (state_.learning.empty()) return;
    state_.bindings.emplace_back(std::exchange(state_.learning, ""), "controller 7 of channel 1");
  }

 private:
  mutable std::mutex mutex_;
  desk::MidiState state_{.device = "nanoKONTROL2", .learning = {}, .bindings = {}};
};

/// The page of a rig that is not there, at any port, with its file in a folder of its own.
class PageTest : public testing::Test {
 protected:
  PageTest() {
    ::setenv("XDG_RUNTIME_DIR", scratch_.path().c_str(), 1);
    ::setenv("HANDCAST_SCOPE", "page-test", 1);
    rig_.name = "table" + std::to_string(::getpid());
    rig_.desk.page.listen = "127.0.0.1:0";
    open();
  }

  void open() {
    page_.reset();
    auto page = desk::open_page(rig_, {panel_, &cues_, &midi_, rig_file()});
    ASSERT_TRUE(page) << page.error().what;
    page_ = std::move(*page);
    address_ = *control::read_desk_file(*control::desk_file(rig_.name));
    const auto colon = address_.url.rfind(':');
    std::from_chars(address_.url.data() + colon + 1, address_.url.data() + address_.url.size(),
                    port_);
  }

  std::filesystem::path rig_file() const { return scratch_.path() / "table.toml"; }
  /// The headers of a program with the token of a role.
  HttpHeaders as(control::Role role) const {
    return {{"Authorization", "Bearer " + address_.tokens[static_cast<std::size_t>(role)]}};
  }
  Answer post(const std::string& path, const std::string& body, control::Role role) const {
    return ask(port_, "POST", path, as(role), body);
  }
  /// Opens a stream, once something of it has come.
  std::unique_ptr<Wire> stream(const std::string& path, control::Role role,
                               std::string_view until) const {
    auto wire = std::make_unique<Wire>(port_);
    wire->send(request_text(port_, "GET", path, as(role)));
    wire->receive(until);
    return wire;
  }

  Scratch scratch_;
  config::Rig rig_;
  TablePanel panel_;
  TableCues cues_;
  TableMidi midi_;
  std::unique_ptr<desk::Surface> page_;
  control::DeskAddress address_;
  std::uint16_t port_ = 0;
};

}  // namespace handcast::test
