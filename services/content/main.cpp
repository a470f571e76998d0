// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "ipc/msg/guest_picture.hpp"
#include "services/content/contents.hpp"
#include "services/runtime/context.hpp"
#include "services/runtime/scheduling.hpp"

using namespace handcast;
using service::must;

/// The state of an idle service is published so often, for `handcast content`.
static constexpr std::int64_t kStateEvery_ns = 500'000'000;

static content::Streams streams_of(service::Context& context) {
  const auto pictures = [&](std::string_view stream) {
    return must(context.writer<msg::ContentPicture>(stream));
  };
  return {.poses = must(context.reader<msg::HandPoses>("pose.hands")),
          .live = must(context.reader<msg::LiveSettings>(msg::kLiveSettings)),
          .images = must(ipc::Reader<msg::CameraFrame>::watch(must(context.ring("camera.frames")))),
          .states = must(context.writer<msg::ContentState>("content.state")),
          .pictures = {pictures("content.left"), pictures("content.right")}};
}

/// Gives further mappings of the rings of other people's programs.
static ipc::OpenRing guests_of(service::Context& context) {
  const auto guests = std::make_shared<std::map<std::string, ipc::Segment, std::less<>>>();
  for (const auto stream : msg::kGuestPictures) guests->emplace(stream, must(context.ring(stream)));
  return [guests](std::string_view stream) -> Result<ipc::Segment> {
    const auto found = guests->find(stream);
    if (found == guests->end())
      return fail(Errc::bad_config, fmt::format("there is no ring {}", stream));
    return ipc::Segment::open(UniqueFd(::dup(found->second.fd())));
  };
}

/// The last state in a ring; empty if there is none.
static std::optional<msg::ContentState> last_state(const service::Context& context) {
  auto reader = ipc::Reader<msg::ContentState>::watch(must(context.ring("content.state")));
  if (!reader) return std::nullopt;
  const auto state = reader->latest(Deadline::now());
  return state ? std::optional(**state) : std::nullopt;
}

/// Draws the contents of the hands content.rate_hz times a second, until the service ends. At low
/// priority: where cores are short, content is late rather than the light.
static void run_content(service::Context& context) {
  service::give_way();
  const auto& filed = context.filed();
  const auto& calibration = context.calibration();
  auto hands = must(content::Hands::load(filed, calibration));
  const auto checked =
      content::check_contents(hands, filed.content, calibration, last_state(context));
  if (!checked) service::give_up(checked.error());
  context.stand_by();
  const auto before = last_state(context);
  content::Contents contents(
      std::move(hands), filed, calibration, streams_of(context), guests_of(context),
      [&](const Error& error) { context.tolerate(error); }, [&] { (void)context.running(); });
  contents.start(before);
  context.ready();
  const auto period_ns = seconds_to_ns(1 / filed.content.rate_hz);
  std::int64_t due_ns = now_ns(), state_ns = due_ns;
  while (context.running()) {
    const bool is_changed = contents.obey_until(due_ns);
    const std::int64_t begin_ns = now_ns();
    if (begin_ns < due_ns && !is_changed) continue;
    contents.draw(begin_ns + period_ns);
    due_ns = std::max(due_ns + period_ns, now_ns());
    if (begin_ns < state_ns && !is_changed) continue;
    contents.publish_state();
    state_ns = begin_ns + kStateEvery_ns;
  }
}

static Result<void> check_content(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto hands = content::Hands::load(rig, calibration);
  return hands ? content::check_contents(*hands, rig.content, calibration)
               : tl::make_unexpected(hands.error());
}

int main(int argc, char** argv) {
  return service::run({.name = "content",
                       .summary = "Draws what is on the hands: pictures, films, shaders.",
                       .paced_by = "content.rate_hz",
                       .publishes = {"content.left", "content.right", "content.state"},
                       .subscribes = {"pose.hands", "camera.frames", "guest.left", "guest.right",
                                      std::string(msg::kLiveSettings)},
                       .settings = {"content", "hand", "cascade.predict", "cascade.skin"}},
                      argc, argv, run_content, check_content);
}
