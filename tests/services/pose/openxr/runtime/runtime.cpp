// SPDX-License-Identifier: Apache-2.0
// An OpenXR runtime for tests: the loader loads it as it loads any other. It has one instance, one
// session and two hand trackers; what it does, and what goes wrong, its script says (script.hpp).
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "tests/services/pose/openxr/runtime/tracker.hpp"

namespace handcast::test_runtime {
namespace {

/// The times of this runtime are those of CLOCK_MONOTONIC and this, so that a client that does not
/// convert them is found out.
constexpr std::int64_t kShift_ns = 1'000'000'000'000;

constexpr std::array kExtensions{"XR_EXT_hand_tracking", "XR_MND_headless",
                                 "XR_KHR_convert_timespec_time", "XR_EXT_debug_utils"};

struct State {
  std::unique_ptr<Tracker> tracker;
  std::deque<XrSessionState> coming;  ///< states that the client has not heard of yet
  bool is_running = false, was_stopped = false, has_said_the_end = false, has_moved = false;
  std::int64_t zero_ns = std::numeric_limits<std::int64_t>::min();
};
State state;

template <class Handle>
Handle handle(std::uintptr_t number) {
  return reinterpret_cast<Handle>(number);
}

template <std::size_t kSize>
void write(char (&to)[kSize], const char* text) {
  std::strncpy(to, text, kSize - 1);
  to[kSize - 1] = 0;
}

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

void pause_a_little() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

XrResult enumerate_extensions(const char*, std::uint32_t capacity, std::uint32_t* count,
                              XrExtensionProperties* properties) {
  *count = 0;
  for (const auto* extension : kExtensions) {
    if (script().lacks.contains(extension)) continue;
    if (capacity > 0) {
      if (*count == capacity) return XR_ERROR_SIZE_INSUFFICIENT;
      write(properties[*count].extensionName, extension);
      properties[*count].extensionVersion = 1;
    }
    ++*count;
  }
  return XR_SUCCESS;
}

XrResult create_instance(const XrInstanceCreateInfo*, XrInstance* instance) {
  if (script().crashes) std::abort();
  while (script().hangs_at_start) pause_a_little();
  if (script().refuses) return XR_ERROR_RUNTIME_UNAVAILABLE;
  state = {};
  state.tracker = std::make_unique<Tracker>(script().motion.empty() ? swaying_hand()
                                                                    : read_motion(script().motion));
  state.zero_ns =
      script().epoch_ns >= 0 ? script().epoch_ns : std::numeric_limits<std::int64_t>::min();
  *instance = handle<XrInstance>(1);
  return XR_SUCCESS;
}

XrResult get_instance_properties(XrInstance, XrInstanceProperties* properties) {
  properties->runtimeVersion = XR_MAKE_VERSION(0, 1, 2);
  write(properties->runtimeName, "Test Runtime");
  return XR_SUCCESS;
}

XrResult get_system(XrInstance, const XrSystemGetInfo*, XrSystemId* system) {
  if (script().no_system) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *system = 7;
  return XR_SUCCESS;
}

XrResult get_system_properties(XrInstance, XrSystemId, XrSystemProperties* properties) {
  write(properties->systemName, "Test Tracker");
  for (auto* next = static_cast<XrBaseOutStructure*>(properties->next); next; next = next->next)
    if (next->type == XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT)
      reinterpret_cast<XrSystemHandTrackingPropertiesEXT*>(next)->supportsHandTracking =
          script().no_hands ? XR_FALSE : XR_TRUE;
  return XR_SUCCESS;
}

XrResult create_session(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
  if (info->next) return XR_ERROR_VALIDATION_FAILURE;  // headless: there is no graphics binding
  *session = handle<XrSession>(2);
  state.coming.push_back(XR_SESSION_STATE_IDLE);
  if (!script().never_ready) state.coming.push_back(XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

XrResult begin_session(XrSession, const XrSessionBeginInfo*) {
  if (state.is_running) return XR_ERROR_SESSION_RUNNING;
  state.is_running = true;
  for (const auto next :
       {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED})
    state.coming.push_back(next);
  return XR_SUCCESS;
}

XrResult end_session(XrSession) {
  if (!state.is_running) return XR_ERROR_SESSION_NOT_RUNNING;
  state.is_running = false;
  state.coming.push_back(XR_SESSION_STATE_IDLE);
  return XR_SUCCESS;
}

/// What the script wants to happen to the session now.
void look_at_script() {
  if (script().stops && !state.was_stopped) state.coming.push_back(XR_SESSION_STATE_STOPPING);
  if (!script().stops && state.was_stopped) state.coming.push_back(XR_SESSION_STATE_READY);
  state.was_stopped = script().stops;
  if (state.has_said_the_end) return;
  if (script().loses_session) state.coming.push_back(XR_SESSION_STATE_LOSS_PENDING);
  if (script().ends) state.coming.push_back(XR_SESSION_STATE_EXITING);
  state.has_said_the_end = script().loses_session || script().ends;
}

XrResult poll_event(XrInstance, XrEventDataBuffer* buffer) {
  if (script().loses_instance) return XR_ERROR_INSTANCE_LOST;
  if (script().moves_space && !state.has_moved && state.is_running) {
    state.has_moved = true;
    XrEventDataReferenceSpaceChangePending moved{
        .type = XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING,
        .session = handle<XrSession>(2),
        .referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL};
    std::memcpy(buffer, &moved, sizeof moved);
    return XR_SUCCESS;
  }
  look_at_script();
  if (state.coming.empty()) return XR_EVENT_UNAVAILABLE;
  const XrEventDataSessionStateChanged changed{.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED,
                                               .session = handle<XrSession>(2),
                                               .state = state.coming.front()};
  state.coming.pop_front();
  std::memcpy(buffer, &changed, sizeof changed);
  return XR_SUCCESS;
}

XrResult create_space(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space) {
  if (script().no_stage && info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE)
    return XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
  *space = handle<XrSpace>(3);
  return XR_SUCCESS;
}

XrResult create_hand_tracker(XrSession, const XrHandTrackerCreateInfoEXT* info,
                             XrHandTrackerEXT* tracker) {
  *tracker = handle<XrHandTrackerEXT>(10 + static_cast<std::uintptr_t>(info->hand));
  return XR_SUCCESS;
}

XrHandJointLocationEXT location_of(const msg::Joint& joint) {
  const auto& [x, y, z] = joint.position_m;
  const auto& turn = joint.orientation_xyzw;
  return {.locationFlags =
              XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
              XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT,
          .pose = {{turn[0], turn[1], turn[2], turn[3]}, {x, y, z}},
          .radius = joint.radius_m};
}

void spoil(bool is_left, XrHandJointLocationEXT* joints) {
  if (script().unknown_joint && is_left) joints[9].locationFlags = 0;
  if (script().no_number && is_left)
    joints[12].pose.position.y = std::numeric_limits<float>::quiet_NaN();
}

XrResult locate_hand_joints(XrHandTrackerEXT tracker, const XrHandJointsLocateInfoEXT* info,
                            XrHandJointLocationsEXT* locations) {
  while (script().hangs) pause_a_little();
  if (script().loses_session) return XR_ERROR_SESSION_LOST;
  if (script().refuses_times) return XR_ERROR_TIME_INVALID;
  if (locations->jointCount != msg::kJoints) return XR_ERROR_VALIDATION_FAILURE;
  const bool is_left = tracker == handle<XrHandTrackerEXT>(10 + XR_HAND_LEFT_EXT);
  const auto side = is_left ? msg::Side::left : msg::Side::right;
  const std::int64_t time_ns = info->time - kShift_ns;
  if (state.zero_ns == std::numeric_limits<std::int64_t>::min()) state.zero_ns = time_ns;
  const auto hand = script().inactive.contains(is_left ? "left" : "right")
                        ? std::nullopt
                        : state.tracker->hand(script(), side, time_ns - state.zero_ns,
                                              monotonic_ns() - state.zero_ns);
  locations->isActive = hand ? XR_TRUE : XR_FALSE;
  for (std::size_t j = 0; j < msg::kJoints; ++j)
    locations->jointLocations[j] = hand ? location_of(hand->joints[j]) : XrHandJointLocationEXT{};
  if (hand) spoil(is_left, locations->jointLocations);
  return XR_SUCCESS;
}

XrResult convert_timespec_time(XrInstance, const timespec* time, XrTime* result) {
  *result = time->tv_sec * 1'000'000'000 + time->tv_nsec + kShift_ns;
  return XR_SUCCESS;
}

XrResult destroy_instance(XrInstance) { return XR_SUCCESS; }
XrResult destroy_session(XrSession) { return XR_SUCCESS; }
XrResult destroy_space(XrSpace) { return XR_SUCCESS; }
XrResult destroy_hand_tracker(XrHandTrackerEXT) { return XR_SUCCESS; }

template <class Function>
PFN_xrVoidFunction any(Function* function) {
  return reinterpret_cast<PFN_xrVoidFunction>(function);
}

XrResult get_function(XrInstance, const char* name, PFN_xrVoidFunction* function) {
  static const std::map<std::string, PFN_xrVoidFunction> functions{
      {"xrGetInstanceProcAddr", any(get_function)},
      {"xrEnumerateInstanceExtensionProperties", any(enumerate_extensions)},
      {"xrCreateInstance", any(create_instance)},
      {"xrDestroyInstance", any(destroy_instance)},
      {"xrGetInstanceProperties", any(get_instance_properties)},
      {"xrGetSystem", any(get_system)},
      {"xrGetSystemProperties", any(get_system_properties)},
      {"xrCreateSession", any(create_session)},
      {"xrDestroySession", any(destroy_session)},
      {"xrBeginSession", any(begin_session)},
      {"xrEndSession", any(end_session)},
      {"xrPollEvent", any(poll_event)},
      {"xrCreateReferenceSpace", any(create_space)},
      {"xrDestroySpace", any(destroy_space)},
      {"xrCreateHandTrackerEXT", any(create_hand_tracker)},
      {"xrDestroyHandTrackerEXT", any(destroy_hand_tracker)},
      {"xrLocateHandJointsEXT", any(locate_hand_joints)},
      {"xrConvertTimespecTimeToTimeKHR", any(convert_timespec_time)}};
  const auto found = functions.find(name);
  *function = found == functions.end() ? nullptr : found->second;
  return *function ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

// What loader and runtime tell each other, from the loader's specification ("Runtime Interface
// Negotiation"); Debian does not package its header.
struct LoaderInfo {
  std::int32_t kind;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t least_interface, most_interface;
  XrVersion least_api, most_api;
};
struct RuntimeRequest {
  std::int32_t kind;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t interface_version;
  XrVersion api_version;
  PFN_xrGetInstanceProcAddr get_function;
};
constexpr std::int32_t kLoaderInfo = 1, kRuntimeRequest = 3;

}  // namespace
}  // namespace handcast::test_runtime

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const handcast::test_runtime::LoaderInfo* loader,
    handcast::test_runtime::RuntimeRequest* request) {
  using namespace handcast::test_runtime;
  if (loader->kind != kLoaderInfo || loader->size != sizeof(LoaderInfo) ||
      request->kind != kRuntimeRequest || request->size != sizeof(RuntimeRequest))
    return XR_ERROR_INITIALIZATION_FAILED;
  request->interface_version = 1;
  request->api_version = XR_CURRENT_API_VERSION;
  request->get_function = get_function;
  return XR_SUCCESS;
}
