// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/guest_picture.hpp"
#include "services/content/hand_content.hpp"
#include "services/content/hands.hpp"
#include "services/runtime/context.hpp"

using namespace handcast;
using service::must;

/// The state of an idle service is published so often, for `handcast content`.
static constexpr std::int64_t kStateEvery_ns = 500'000'000;

/// The content of both hands, and what moves it.
struct Contents {
  content::Hands hands;
  std::vector<content::HandContent> worn;  ///< left, right
  ipc::Reader<msg::HandPoses> poses;
  ipc::Reader<msg::ContentCommand> commands;
  ipc::Reader<msg::CameraFrame> images;
  std::optional<ipc::Sample<msg::CameraFrame>> image{};  ///< the newest, while a content needs it
  ipc::Writer<msg::ContentState> states;
  std::uint64_t published = 0;
};

/// The rings of other people's programs, by their streams.
using Guests = std::map<std::string, ipc::Segment, std::less<>>;

static Guests take_guests(service::Context& context) {
  Guests guests;
  for (const auto stream : msg::kGuestPictures) guests.emplace(stream, must(context.ring(stream)));
  return guests;
}

/// Another mapping of a guest's ring.
static Result<ipc::Segment> open_again(const Guests& guests, std::string_view stream) {
  const auto found = guests.find(stream);
  if (found == guests.end())
    return fail(Errc::bad_config, fmt::format("there is no ring {}", stream));
  return ipc::Segment::open(UniqueFd(::dup(found->second.fd())));
}

static content::Opening opening_of(const config::Rig& rig, msg::Side side,
                                   const content::Hands& hands) {
  content::Opening like;
  like.width = rig.content.width_px;
  like.height = rig.content.height_px;
  like.meshes = hands.meshes();
  like.side = side;
  like.sound = rig.content.sound;
  return like;
}

static void take_poses(service::Context& context, Contents& all) {
  while (all.poses.await(Deadline::now())) {
    const auto sample = all.poses.next(Deadline::now());
    if (!sample && sample.error().code != Errc::timeout) context.tolerate(sample.error());
    if (!sample) return;
    all.hands.push(**sample);
  }
}

static void publish_state(Contents& all) {
  auto state = all.states.loan();
  if (!state) return;
  state->header.frame_id = ++all.published;
  state->header.origin_ns = now_ns();
  for (std::size_t i = 0; i < all.worn.size(); ++i) state->hands[i] = all.worn[i].state();
  all.states.publish(std::move(state));
}

/// The newest commands for both hands that have come, in their order; older ones are passed over.
static std::vector<msg::ContentCommand> take_commands(service::Context& context, Contents& all) {
  std::vector<msg::ContentCommand> commands;
  while (all.commands.await(Deadline::now())) {
    const auto command = all.commands.next(Deadline::now());
    if (!command && command.error().code != Errc::timeout) context.tolerate(command.error());
    if (!command) break;
    std::erase_if(commands, [&](const auto& old) { return (old.hands & ~(*command)->hands) == 0; });
    commands.push_back(**command);
  }
  return commands;
}

/// Obeys commands. What is begun is announced before, because it may end this process.
static void obey(Contents& all, const std::vector<msg::ContentCommand>& commands) {
  for (const auto& command : commands) {
    for (auto& worn : all.worn) worn.announce(command);
    publish_state(all);
    for (auto& worn : all.worn) worn.obey(command);
  }
}

/// Shows what was asked for last: in the rig file, or by a command. `before`: the state that a
/// process before this one has left.
static void start(service::Context& context, Contents& all,
                  const std::optional<msg::ContentState>& before) {
  for (std::size_t i = 0; i < all.worn.size(); ++i) {
    if (before) all.worn[i].distrust(before->hands[i].trying.view());
    all.worn[i].announce();
  }
  publish_state(all);
  for (auto& worn : all.worn) worn.start();
  auto commands = take_commands(context, all);
  for (auto& command : commands) command.transition_s = 0;
  obey(all, commands);
  for (auto& worn : all.worn) worn.trust();
}

/// The last state in a ring; empty if there is none.
static std::optional<msg::ContentState> last_state(const service::Context& context) {
  auto reader = ipc::Reader<msg::ContentState>::watch(must(context.ring("content.state")));
  if (!reader) return std::nullopt;
  const auto state = reader->latest(Deadline::now());
  return state ? std::optional(**state) : std::nullopt;
}

/// The newest image, as it shows the hands; empty if no content needs it.
static std::optional<content::CameraView> view_of(service::Context& context, Contents& all,
                                                  bool is_needed) {
  if (!is_needed) {
    all.image.reset();
    return std::nullopt;
  }
  if (auto newest = all.images.latest(Deadline::now()))
    all.image = std::move(*newest);
  else if (newest.error().code != Errc::timeout)
    context.tolerate(newest.error());
  if (!all.image) return std::nullopt;
  const msg::CameraFrame& frame = **all.image;
  const auto width = static_cast<int>(frame.width_px);
  return content::CameraView{{{frame.pixels(), width, static_cast<int>(frame.height_px), width},
                              frame.header.origin_ns,
                              frame.header.frame_id},
                             &context.calibration().camera};
}

/// Draws what is due for both hands. A hand that is not there needs no new pictures.
static void draw(service::Context& context, Contents& all, std::int64_t time_ns) {
  content::Needs needs;
  for (const auto& worn : all.worn) needs |= worn.needs();
  all.hands.needs_surface(needs.surface || needs.camera);
  const auto hands = all.hands.at(time_ns);
  auto view = view_of(context, all, needs.camera);
  content::BothHands seen;
  if (view) seen = all.hands.seen_at(view->image.origin_ns);
  for (std::size_t i = 0; i < all.worn.size(); ++i) {
    if (!hands[i].is_there && !all.worn[i].is_due()) continue;
    if (view) {
      view->hand = &seen[i];
      view->other = &seen[1 - i];
    }
    all.worn[i].draw(hands[i], hands[1 - i], time_ns, view ? &*view : nullptr);
  }
}

/// Opens both contents, but for one that is `known`.
static Result<void> check_contents(const config::Rig& rig, const content::Hands& hands,
                                   const std::optional<msg::ContentState>& known = {}) {
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const bool is_left = side == msg::Side::left;
    const auto& text = is_left ? rig.content.left : rig.content.right;
    if (known && known->hands[static_cast<std::size_t>(side)].settings.view() == text) continue;
    const auto* const name = is_left ? "content.left" : "content.right";
    const auto written = config::parse_content(text);
    if (!written) return fail_in(name, written.error());
    const auto chain = content::Chain::open(*written, opening_of(rig, side, hands));
    if (!chain && chain.error().code == Errc::bad_config) return fail_in(name, chain.error());
  }
  return {};
}

/// Draws the contents of the hands content.rate_hz times a second, until the service ends. At low
/// priority: where cores are short, content is late rather than the light.
static void run_content(service::Context& context) {
  if (::nice(10) == -1) log::debug("the priority cannot be lowered");
  const auto& rig = context.rig();
  auto hands = must(content::Hands::load(rig, context.calibration()));
  // A service that is started again goes on with a content whose files are gone meanwhile.
  if (const auto checked = check_contents(rig, hands, last_state(context)); !checked)
    service::give_up(checked.error());
  context.stand_by();
  const auto guests = take_guests(context);
  const auto before = last_state(context);
  Contents all{
      .hands = std::move(hands),
      .worn = {},
      .poses = must(context.reader<msg::HandPoses>("pose.hands")),
      .commands = must(context.reader<msg::ContentCommand>(msg::kContentCommands)),
      .images = must(ipc::Reader<msg::CameraFrame>::watch(must(context.ring("camera.frames")))),
      .states = must(context.writer<msg::ContentState>("content.state"))};
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto* const stream = side == msg::Side::left ? "content.left" : "content.right";
    auto like = opening_of(rig, side, all.hands);
    like.ring = [&guests](std::string_view guest) { return open_again(guests, guest); };
    all.worn.emplace_back(std::move(like), rig.content,
                          must(context.writer<msg::ContentPicture>(stream)));
  }
  start(context, all, before);
  context.ready();
  const auto period_ns = seconds_to_ns(1 / rig.content.rate_hz);
  std::int64_t due_ns = now_ns(), state_ns = due_ns;
  while (context.running()) {
    // A command is obeyed at once.
    std::vector<msg::ContentCommand> commands;
    if (all.commands.await(Deadline::at_ns(due_ns))) commands = take_commands(context, all);
    obey(all, commands);
    const bool is_changed = !commands.empty();
    const std::int64_t begin_ns = now_ns();
    if (begin_ns < due_ns && !is_changed) continue;
    take_poses(context, all);
    draw(context, all, begin_ns + period_ns);
    due_ns = std::max(due_ns + period_ns, now_ns());
    if (begin_ns < state_ns && !is_changed) continue;
    publish_state(all);
    state_ns = begin_ns + kStateEvery_ns;
  }
}

static Result<void> check_content(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto hands = content::Hands::load(rig, calibration);
  return hands ? check_contents(rig, *hands) : tl::make_unexpected(hands.error());
}

int main(int argc, char** argv) {
  return service::run({.name = "content",
                       .summary = "Draws what is on the hands: pictures, films, shaders.",
                       .paced_by = "content.rate_hz",
                       .publishes = {"content.left", "content.right", "content.state"},
                       .subscribes = {"pose.hands", "camera.frames", "guest.left", "guest.right",
                                      std::string(msg::kContentCommands)},
                       .settings = {"content", "hand", "cascade.predict", "cascade.skin"}},
                      argc, argv, run_content, check_content);
}
