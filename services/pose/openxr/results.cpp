// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/results.hpp"

#include <fmt/format.h>
#include <openxr/openxr_reflection.h>

namespace handcast::pose::openxr {

Errc code_of(XrResult result) {
  switch (result) {
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_SESSION_LOST:
    case XR_ERROR_RUNTIME_FAILURE:
    case XR_ERROR_HANDLE_INVALID:
    case XR_SESSION_LOSS_PENDING:
      return Errc::disconnected;
    default:
      return Errc::bad_data;
  }
}

std::string word_of(XrResult result) {
  switch (result) {
#define HANDCAST_RESULT(name, value) \
  case name:                         \
    return #name;
    XR_LIST_ENUM_XrResult(HANDCAST_RESULT)
#undef HANDCAST_RESULT
        default : return fmt::format("result {}", static_cast<int>(result));
  }
}

}  // namespace handcast::pose::openxr

#define XR_USE_TIMESPEC
#include <fmt/format.h>
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <ctime>
#include <vector>

#include "services/pose/openxr/results.hpp"

namespace handcast::pose::openxr {
namespace {

/// An extension that is needed, and what it is for.
struct Need {
  const char* extension;
  const char* lack;  ///< the end of the sentence if a runtime does not have it
};
constexpr std::array<Need, 3> kNeeds{
    Need{XR_EXT_HAND_TRACKING_EXTENSION_NAME, "has no hand tracking"},
    Need{XR_MND_HEADLESS_EXTENSION_NAME,
         "cannot be used by a program that draws nothing in it; use one that can, e.g. Monado"},
    Need{XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME,
         "does not say how its times and those of this computer belong together"}};

}  // namespace

std::array<const char*, 3> needed_extensions() {
  std::array<const char*, kNeeds.size()> extensions{};
  for (std::size_t i = 0; i < kNeeds.size(); ++i) extensions[i] = kNeeds[i].extension;
  return extensions;
}

Result<void> check_extensions(const std::string& runtime) {
  std::uint32_t count = 0;
  std::vector<XrExtensionProperties> has;
  auto result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  if (XR_SUCCEEDED(result)) {
    has.assign(count, {.type = XR_TYPE_EXTENSION_PROPERTIES});
    result = xrEnumerateInstanceExtensionProperties(nullptr, count, &count, has.data());
  }
  if (XR_FAILED(result))
    return fail(Errc::unavailable,
                fmt::format("the OpenXR runtime '{}' cannot be loaded ({}); XR_LOADER_DEBUG=all "
                            "shows why",
                            runtime, word_of(result)));
  for (const auto& need : kNeeds) {
    bool is_there = false;
    for (const auto& one : has) is_there |= text_of(one.extensionName) == need.extension;
    if (!is_there)
      return fail(Errc::bad_config, fmt::format("the OpenXR runtime '{}' {} (it lacks {})", runtime,
                                                need.lack, need.extension));
  }
  return {};
}

}  // namespace handcast::pose::openxr
