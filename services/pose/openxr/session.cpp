// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/session.hpp"

#define XR_USE_TIMESPEC
#include <fmt/format.h>
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <optional>
#include <utility>

#include "ipc/base/log.hpp"
#include "services/pose/openxr/manifest.hpp"
#include "services/pose/openxr/results.hpp"

namespace handcast::pose::openxr {
namespace {

constexpr std::int64_t kLookEvery_ns = 2'000'000;  ///< for the events of a session that begins

/// Sets an environment variable for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_ ? ::setenv(name_, before_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

msg::Joint joint_of(const XrHandJointLocationEXT& location) {
  const auto& [turn, place] = location.pose;
  return {.position_m = {place.x, place.y, place.z},
          .orientation_xyzw = {turn.x, turn.y, turn.z, turn.w},
          .radius_m = location.radius};
}

Answer answer_of(bool is_active, const std::array<XrHandJointLocationEXT, msg::kJoints>& all) {
  constexpr XrSpaceLocationFlags kKnown =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  Answer answer{.is_active = is_active, .is_whole = true};
  for (std::size_t j = 0; j < all.size(); ++j) {
    answer.is_whole &= (all[j].locationFlags & kKnown) == kKnown;
    answer.tracked += (all[j].locationFlags & XR_SPACE_LOCATION_POSITION_TRACKED_BIT) != 0;
    answer.joints[j] = joint_of(all[j]);
  }
  return answer;
}

class LoadedSession final : public Session {
 public:
  ~LoadedSession() override {
    // The runtime destroys what belongs to an instance with it.
    if (instance_) xrDestroyInstance(instance_);
  }

  Result<void> start(const config::OpenXr& settings, const Manifest& manifest) {
    name_ = manifest.name;
    // The loader reads them when it loads the runtime, and writes its own words to the log.
    const Variable runtime("XR_RUNTIME_JSON", manifest.file);
    const char* wanted = std::getenv("XR_LOADER_DEBUG");
    const Variable words("XR_LOADER_DEBUG", wanted ? wanted : "none");
    return check_extensions(name_)
        .and_then([this] { return create_instance(); })
        .and_then([this] { return find_functions(); })
        .and_then([this] { return find_system(); })
        .and_then([this] { return create_session(); })
        .and_then([&] { return create_space(settings.space); })
        .and_then([this] { return create_trackers(); });
  }

  Result<void> wait_until_ready(Deadline deadline) {
    for (;;) {
      auto tended = tend();
      if (tended || tended.error().code != Errc::timeout) return tended;
      if (deadline.passed())
        return fail(Errc::unavailable, name_ +
                                           " has not made its session ready; does it run, and "
                                           "is another program using it?");
      sleep_until_ns(now_ns() + kLookEvery_ns);
    }
  }

  Result<void> tend() override {
    for (;;) {
      XrEventDataBuffer event{.type = XR_TYPE_EVENT_DATA_BUFFER};
      const auto result = xrPollEvent(instance_, &event);
      if (result == XR_EVENT_UNAVAILABLE) break;
      if (XR_FAILED(result)) return failed("xrPollEvent", result);
      if (auto handled = handle(event); !handled) return handled;
    }
    if (is_running_) return {};
    return fail(Errc::timeout, name_ + " has stopped the session");
  }

  Result<Answers> locate(std::int64_t time_ns) override {
    const timespec time{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
    XrTime at = 0;
    if (const auto result = convert_(instance_, &time, &at); XR_FAILED(result))
      return failed("xrConvertTimespecTimeToTimeKHR", result);
    Answers answers;
    for (std::size_t side = 0; side < answers.size(); ++side) {
      std::array<XrHandJointLocationEXT, msg::kJoints> joints{};
      XrHandJointLocationsEXT locations{.type = XR_TYPE_HAND_JOINT_LOCATIONS_EXT,
                                        .jointCount = msg::kJoints,
                                        .jointLocations = joints.data()};
      const XrHandJointsLocateInfoEXT info{
          .type = XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT, .baseSpace = space_, .time = at};
      const auto result = locate_(trackers_[side], &info, &locations);
      if (result != XR_SUCCESS) return failed("xrLocateHandJointsEXT", result);
      answers[side] = answer_of(locations.isActive == XR_TRUE, joints);
    }
    return answers;
  }

  const std::string& name() const override { return name_; }

 private:
  tl::unexpected<Error> failed(const char* what, XrResult result) const {
    return fail(code_of(result), fmt::format("{}: {} gives {}", name_, what, word_of(result)));
  }
  tl::unexpected<Error> unavailable(const char* what, XrResult result) const {
    return fail(Errc::unavailable, fmt::format("{}: {} ({})", name_, what, word_of(result)));
  }

  Result<void> create_instance() {
    const auto extensions = needed_extensions();
    XrInstanceCreateInfo info{
        .type = XR_TYPE_INSTANCE_CREATE_INFO,
        .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
        .enabledExtensionNames = extensions.data()};
    std::strcpy(info.applicationInfo.applicationName, "handcast");
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    if (const auto result = xrCreateInstance(&info, &instance_); XR_FAILED(result)) {
      instance_ = XR_NULL_HANDLE;
      return unavailable("it does not start; does its service run?", result);
    }
    XrInstanceProperties properties{.type = XR_TYPE_INSTANCE_PROPERTIES};
    if (XR_SUCCEEDED(xrGetInstanceProperties(instance_, &properties)))
      name_ = fmt::format("{} {}.{}.{}", text_of(properties.runtimeName),
                          XR_VERSION_MAJOR(properties.runtimeVersion),
                          XR_VERSION_MINOR(properties.runtimeVersion),
                          XR_VERSION_PATCH(properties.runtimeVersion));
    return {};
  }

  template <class Function>
  bool find(const char* name, Function& function) {
    PFN_xrVoidFunction found = nullptr;
    const auto result = xrGetInstanceProcAddr(instance_, name, &found);
    function = reinterpret_cast<Function>(found);
    return XR_SUCCEEDED(result) && found;
  }
  Result<void> find_functions() {
    if (find("xrCreateHandTrackerEXT", create_tracker_) && find("xrLocateHandJointsEXT", locate_) &&
        find("xrConvertTimespecTimeToTimeKHR", convert_))
      return {};
    return fail(Errc::bad_config, name_ + " names extensions whose functions it does not have");
  }

  Result<void> find_system() {
    const XrSystemGetInfo info{.type = XR_TYPE_SYSTEM_GET_INFO,
                               .formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    if (const auto result = xrGetSystem(instance_, &info, &system_); XR_FAILED(result))
      return unavailable("nothing that it knows is attached", result);
    XrSystemHandTrackingPropertiesEXT hands{.type = XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT};
    XrSystemProperties properties{.type = XR_TYPE_SYSTEM_PROPERTIES, .next = &hands};
    if (const auto result = xrGetSystemProperties(instance_, system_, &properties);
        XR_FAILED(result))
      return unavailable("it does not describe what is attached", result);
    name_ += fmt::format(", '{}'", text_of(properties.systemName));
    if (hands.supportsHandTracking == XR_TRUE) return {};
    return fail(Errc::unavailable, name_ + ": it has no hand tracker now; is one attached?");
  }

  Result<void> create_session() {
    const XrSessionCreateInfo info{.type = XR_TYPE_SESSION_CREATE_INFO, .systemId = system_};
    const auto result = xrCreateSession(instance_, &info, &session_);
    return XR_SUCCEEDED(result) ? Result<void>() : unavailable("it gives no session", result);
  }

  Result<void> create_space(config::OpenXrSpace space) {
    constexpr std::array kTypes{XR_REFERENCE_SPACE_TYPE_LOCAL, XR_REFERENCE_SPACE_TYPE_STAGE,
                                XR_REFERENCE_SPACE_TYPE_VIEW};
    space_type_ = kTypes[static_cast<std::size_t>(space)];
    const XrReferenceSpaceCreateInfo info{.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO,
                                          .referenceSpaceType = space_type_,
                                          .poseInReferenceSpace = {{0, 0, 0, 1}, {0, 0, 0}}};
    const auto result = xrCreateReferenceSpace(session_, &info, &space_);
    if (XR_SUCCEEDED(result)) return {};
    return fail(Errc::bad_config,
                fmt::format("{} has no space '{}' ({}); set pose.openxr.space", name_,
                            words_of(space)[static_cast<std::size_t>(space)], word_of(result)));
  }

  Result<void> create_trackers() {
    for (std::size_t side = 0; side < trackers_.size(); ++side) {
      const XrHandTrackerCreateInfoEXT info{
          .type = XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT,
          .hand = side == static_cast<std::size_t>(msg::Side::left) ? XR_HAND_LEFT_EXT
                                                                    : XR_HAND_RIGHT_EXT,
          .handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT};
      if (const auto result = create_tracker_(session_, &info, &trackers_[side]); XR_FAILED(result))
        return unavailable("it gives no hand tracker", result);
    }
    return {};
  }

  Result<void> handle(const XrEventDataBuffer& event) {
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING)
      return fail(Errc::disconnected, name_ + " ends");
    if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
      const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
      if (change.referenceSpaceType == space_type_)
        log::warning(
            "pose 'openxr': {} moves the origin of the joints; the tracker's place in the "
            "calibration is no longer right",
            name_);
    }
    if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) return {};
    return enter(reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state);
  }

  Result<void> enter(XrSessionState state) {
    if (state == XR_SESSION_STATE_LOSS_PENDING)
      return fail(Errc::disconnected, name_ + " has lost the session");
    if (state == XR_SESSION_STATE_EXITING)
      return fail(Errc::disconnected, name_ + " has ended the session");
    if (state == XR_SESSION_STATE_STOPPING) {
      is_running_ = false;
      const auto result = xrEndSession(session_);
      return XR_SUCCEEDED(result) ? Result<void>() : failed("xrEndSession", result);
    }
    if (state != XR_SESSION_STATE_READY || is_running_) return {};
    const XrSessionBeginInfo info{
        .type = XR_TYPE_SESSION_BEGIN_INFO,
        .primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
    const auto result = xrBeginSession(session_, &info);
    if (XR_FAILED(result)) return failed("xrBeginSession", result);
    is_running_ = true;
    return {};
  }

  std::string name_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace space_ = XR_NULL_HANDLE;
  XrReferenceSpaceType space_type_ = XR_REFERENCE_SPACE_TYPE_LOCAL;
  std::array<XrHandTrackerEXT, 2> trackers_{};
  bool is_running_ = false;
  PFN_xrCreateHandTrackerEXT create_tracker_ = nullptr;
  PFN_xrLocateHandJointsEXT locate_ = nullptr;
  PFN_xrConvertTimespecTimeToTimeKHR convert_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<Session>> Session::open(const config::OpenXr& settings, Deadline deadline) {
  auto manifest = find_runtime(settings.runtime);
  if (!manifest) return tl::make_unexpected(std::move(manifest.error()));
  auto session = std::make_unique<LoadedSession>();
  if (auto started = session->start(settings, *manifest); !started)
    return tl::make_unexpected(std::move(started.error()));
  if (auto ready = session->wait_until_ready(deadline); !ready)
    return tl::make_unexpected(std::move(ready.error()));
  return session;
}

}  // namespace handcast::pose::openxr
