// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/context.hpp"

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

Result<Functions> load_functions(FindFunction find) {
  Functions gl;
#define HANDCAST_GL_LOAD(type, name)                               \
  gl.name = reinterpret_cast<PFNGL##type##PROC>(find("gl" #name)); \
  if (gl.name == nullptr)                                          \
    return fail(Errc::unavailable, fmt::format("the driver has no function gl{}", #name));
  HANDCAST_GL_FUNCTIONS(HANDCAST_GL_LOAD)
#undef HANDCAST_GL_LOAD
  return gl;
}

namespace {

constexpr std::array kContext{EGL_CONTEXT_MAJOR_VERSION,       4,
                              EGL_CONTEXT_MINOR_VERSION,       5,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};

/// A context that reports a reset of the GPU, or, if the driver has none, one that does not.
EGLContext create_context(const Egl& egl, EGLDisplay display, EGLConfig config, EGLContext shared) {
  std::array<EGLint, kContext.size() + 3> attributes{};
  std::copy(kContext.begin(), kContext.end(), attributes.begin());
  attributes[kContext.size()] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY;
  attributes[kContext.size() + 1] = EGL_LOSE_CONTEXT_ON_RESET;
  attributes.back() = EGL_NONE;
  EGLContext context = egl.CreateContext(display, config, shared, attributes.data());
  if (context == EGL_NO_CONTEXT) {
    attributes[kContext.size()] = EGL_NONE;
    context = egl.CreateContext(display, config, shared, attributes.data());
  }
  return context;
}

/// A configuration of the display for contexts without a surface; EGL_NO_CONFIG_KHR if it needs
/// none.
EGLConfig config_of(const Egl& egl, EGLDisplay display, const char* extensions) {
  if (has_extension(extensions, "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
  constexpr std::array<EGLint, 5> kWanted{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE,
                                          EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = EGL_NO_CONFIG_KHR;
  EGLint count = 0;
  egl.ChooseConfig(display, kWanted.data(), &config, 1, &count);
  return config;
}

bool draws_in_software(std::string_view renderer) {
  for (const std::string_view name : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "lavapipe"})
    if (renderer.find(name) != std::string_view::npos) return true;
  return false;
}

std::string_view reset_name(GLenum status) {
  switch (status) {
    case GL_GUILTY_CONTEXT_RESET:
      return "the GPU was reset because of this program";
    case GL_INNOCENT_CONTEXT_RESET:
      return "the GPU was reset because of another program";
    default:
      return "the GPU was reset";
  }
}

}  // namespace

std::string Gpu::sentence() const {
  return fmt::format("{}, {}", renderer, is_software ? "a software renderer" : "a hardware GPU");
}

Result<std::unique_ptr<Context>> Context::open(const ShareGroup& shares) {
  const auto egl = load_egl();
  if (!egl) return tl::make_unexpected(egl.error());
  if (shares) return open(*egl, {shares.display, "the window's"}, shares.context);
  std::string reasons;
  for (const DisplayCandidate& candidate : display_candidates(*egl)) {
    auto context = open(*egl, candidate, EGL_NO_CONTEXT);
    if (context) return context;
    reasons += fmt::format("; {}: {}", candidate.platform, context.error().what);
  }
  return fail(Errc::unavailable,
              fmt::format("no display of EGL has OpenGL 4.5 core without a window{}",
                          reasons.empty() ? "; EGL lists none" : reasons));
}

Result<std::unique_ptr<Context>> Context::open(const Egl& egl, const DisplayCandidate& candidate,
                                               EGLContext shared) {
  const auto failed = [&](const char* what) {
    return fail(Errc::unavailable, fmt::format("{} ({})", what, error_name(egl.GetError())));
  };
  if (candidate.display == EGL_NO_DISPLAY) return failed("there is no such display");
  if (!egl.Initialize(candidate.display, nullptr, nullptr)) return failed("it cannot be opened");
  const char* const extensions = egl.QueryString(candidate.display, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_KHR_surfaceless_context"))
    return fail(Errc::unavailable, "it has no EGL_KHR_surfaceless_context");
  if (!egl.BindAPI(EGL_OPENGL_API)) return failed("it has no OpenGL");
  const EGLConfig config = config_of(egl, candidate.display, extensions);
  EGLContext handle = create_context(egl, candidate.display, config, shared);
  if (handle == EGL_NO_CONTEXT) return failed("it has no OpenGL 4.5 core");
  std::unique_ptr<Context> context(new Context(egl, candidate.display, handle));
  if (const auto loaded = context->load(candidate.platform); !loaded)
    return tl::make_unexpected(loaded.error());
  return context;
}

Result<void> Context::load(const std::string& platform) {
  if (!make_current()) return fail(Errc::unavailable, *lost_);
  auto functions = load_functions(egl_.GetProcAddress);
  if (!functions) return tl::make_unexpected(functions.error());
  gl_ = *functions;
  const auto text = [&](GLenum name) {
    const GLubyte* const value = gl_.GetString(name);
    return std::string(value ? reinterpret_cast<const char*>(value) : "unknown");
  };
  gpu_ = {text(GL_RENDERER), text(GL_VERSION), platform, false};
  gpu_.is_software = draws_in_software(gpu_.renderer);
  return {};
}

Context::~Context() {
  release();
  egl_.DestroyContext(display_, context_);
}

bool Context::make_current() {
  if (lost_) return false;
  if (egl_.GetCurrentContext() == context_) return true;
  if (egl_.BindAPI(EGL_OPENGL_API) &&
      egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    return true;
  lose(fmt::format("the context of OpenGL cannot be used ({})", error_name(egl_.GetError())));
  return false;
}

void Context::release() {
  if (egl_.GetCurrentContext() == context_)
    egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void Context::check() {
  if (lost_) return;
  if (const GLenum status = gl_.GetGraphicsResetStatus(); status != GL_NO_ERROR) {
    lose(std::string(reset_name(status)));
  } else if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
    lose(error == GL_OUT_OF_MEMORY ? "the GPU is out of memory"
                                   : fmt::format("OpenGL reports error {:#x}", error));
  }
}

void Context::lose(std::string reason) {
  if (!lost_) lost_ = std::move(reason);
}

}  // namespace handcast::renderer::gl
