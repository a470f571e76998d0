// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/egl.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <string_view>

namespace handcast::renderer::gl {
namespace {

std::vector<EGLDeviceEXT> devices_of(const Egl& egl) {
  EGLint count = 0;
  if (!egl.QueryDevices || !egl.QueryDevices(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!egl.QueryDevices(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(count));
  return devices;
}

}  // namespace

Result<Egl> load_egl() {
  void* const library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr)
    return fail(Errc::unavailable,
                fmt::format("EGL is not installed ({}); its package is libegl1", dlerror()));
  Egl egl;
#define HANDCAST_EGL_LOAD(type, name)                                           \
  egl.name = reinterpret_cast<PFNEGL##type##PROC>(dlsym(library, "egl" #name)); \
  if (egl.name == nullptr)                                                      \
    return fail(Errc::unavailable, fmt::format("libEGL has no function egl{}", #name));
  HANDCAST_EGL_FUNCTIONS(HANDCAST_EGL_LOAD)
#undef HANDCAST_EGL_LOAD
  const char* const extensions = egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_EXT_platform_base"))
    return fail(Errc::unavailable,
                "EGL finds no driver with platform displays (EGL_EXT_platform_base)");
  egl.GetPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      egl.GetProcAddress("eglGetPlatformDisplayEXT"));
  if (has_extension(extensions, "EGL_EXT_device_enumeration") ||
      has_extension(extensions, "EGL_EXT_device_base")) {
    egl.QueryDevices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.GetProcAddress("eglQueryDevicesEXT"));
    egl.QueryDeviceString = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
        egl.GetProcAddress("eglQueryDeviceStringEXT"));
  }
  return egl;
}

std::string error_name(EGLint error) {
  static constexpr std::array<const char*, 15> kNames{
      "EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
      "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
      "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
      "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
      "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
  const auto index = static_cast<std::size_t>(error - EGL_SUCCESS);
  return index < kNames.size() ? kNames[index] : fmt::format("EGL error {:#x}", error);
}

bool has_extension(const char* list, const char* extension) {
  if (list == nullptr) return false;
  std::string_view rest = list;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == extension) return true;
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return false;
}

std::vector<DisplayCandidate> display_candidates(const Egl& egl) {
  const char* const extensions = egl.QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<DisplayCandidate> hardware, software;
  if (has_extension(extensions, "EGL_EXT_platform_device")) {
    for (EGLDeviceEXT device : devices_of(egl)) {
      const bool is_software =
          has_extension(egl.QueryDeviceString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
      auto& candidates = is_software ? software : hardware;
      candidates.push_back(
          {egl.GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr),
           fmt::format("{}device {}", is_software ? "software " : "", candidates.size())});
    }
  }
  if (has_extension(extensions, "EGL_MESA_platform_surfaceless"))
    hardware.push_back(
        {egl.GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
         "surfaceless"});
  hardware.insert(hardware.end(), software.begin(), software.end());
  return hardware;
}

}  // namespace handcast::renderer::gl
