// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <memory>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::renderer::gl {

/// The functions of EGL that this back end calls: the part of the type's name in egl.h, and the
/// name without `egl`.
#define HANDCAST_EGL_FUNCTIONS(F)         \
  F(BINDAPI, BindAPI)                     \
  F(CHOOSECONFIG, ChooseConfig)           \
  F(CREATECONTEXT, CreateContext)         \
  F(DESTROYCONTEXT, DestroyContext)       \
  F(GETCURRENTCONTEXT, GetCurrentContext) \
  F(GETERROR, GetError)                   \
  F(GETPROCADDRESS, GetProcAddress)       \
  F(INITIALIZE, Initialize)               \
  F(MAKECURRENT, MakeCurrent)             \
  F(QUERYSTRING, QueryString)

/// libEGL, loaded at run time: a machine without it draws with another back end. It stays loaded,
/// and its displays stay initialised, until the process ends, because eglTerminate() would end the
/// contexts of everyone in the process.
struct Egl {
#define HANDCAST_EGL_MEMBER(type, name) PFNEGL##type##PROC name = nullptr;
  HANDCAST_EGL_FUNCTIONS(HANDCAST_EGL_MEMBER)
#undef HANDCAST_EGL_MEMBER
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;  ///< of EGL_EXT_platform_base
  /// Of EGL_EXT_device_enumeration; nullptr without it.
  /// @{
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
  /// @}
};

/// Loads libEGL. Errors (unavailable): it is not installed, or has no platform displays.
Result<Egl> load_egl();

/// The name of an error of eglGetError(), e.g. "EGL_BAD_MATCH".
std::string error_name(EGLint error);

/// Returns true if a list of extensions, separated by spaces, has this one. `list` may be nullptr.
bool has_extension(const char* list, const char* extension);

/// A display that may have a GPU behind it, not opened yet.
struct DisplayCandidate {
  EGLDisplay display = EGL_NO_DISPLAY;  ///< of eglGetPlatformDisplay()
  std::string platform;                 ///< e.g. "device 0", "surfaceless"
};

/// The displays that need no window system, in the order in which to try them: the devices of
/// EGL_EXT_platform_device that are hardware, EGL_MESA_platform_surfaceless, then software devices.
std::vector<DisplayCandidate> display_candidates(const Egl& egl);

}  // namespace handcast::renderer::gl
