// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/device_image.hpp"

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

/// The functions of OpenGL that this back end calls: the name of the type's part in glcorearb.h,
/// and the name without `gl`.
#define HANDCAST_GL_FUNCTIONS(F)                              \
  F(ATTACHSHADER, AttachShader)                               \
  F(BEGINQUERY, BeginQuery)                                   \
  F(BINDBUFFER, BindBuffer)                                   \
  F(BINDBUFFERBASE, BindBufferBase)                           \
  F(BINDFRAMEBUFFER, BindFramebuffer)                         \
  F(BINDIMAGETEXTURE, BindImageTexture)                       \
  F(BINDTEXTUREUNIT, BindTextureUnit)                         \
  F(BINDVERTEXARRAY, BindVertexArray)                         \
  F(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus) \
  F(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv)         \
  F(CLEARNAMEDFRAMEBUFFERUIV, ClearNamedFramebufferuiv)       \
  F(CLEARTEXIMAGE, ClearTexImage)                             \
  F(CLEARTEXSUBIMAGE, ClearTexSubImage)                       \
  F(CLIENTWAITSYNC, ClientWaitSync)                           \
  F(CLIPCONTROL, ClipControl)                                 \
  F(COMPILESHADER, CompileShader)                             \
  F(COPYNAMEDBUFFERSUBDATA, CopyNamedBufferSubData)           \
  F(CREATEBUFFERS, CreateBuffers)                             \
  F(CREATEFRAMEBUFFERS, CreateFramebuffers)                   \
  F(CREATEPROGRAM, CreateProgram)                             \
  F(CREATEQUERIES, CreateQueries)                             \
  F(CREATESHADER, CreateShader)                               \
  F(CREATETEXTURES, CreateTextures)                           \
  F(CREATEVERTEXARRAYS, CreateVertexArrays)                   \
  F(CULLFACE, CullFace)                                       \
  F(DELETEBUFFERS, DeleteBuffers)                             \
  F(DELETEFRAMEBUFFERS, DeleteFramebuffers)                   \
  F(DELETEPROGRAM, DeleteProgram)                             \
  F(DELETEQUERIES, DeleteQueries)                             \
  F(DELETESHADER, DeleteShader)                               \
  F(DELETESYNC, DeleteSync)                                   \
  F(DELETETEXTURES, DeleteTextures)                           \
  F(DELETEVERTEXARRAYS, DeleteVertexArrays)                   \
  F(DEPTHFUNC, DepthFunc)                                     \
  F(DISABLE, Disable)                                         \
  F(DISPATCHCOMPUTEINDIRECT, DispatchComputeIndirect)         \
  F(DISPATCHCOMPUTE, DispatchCompute)                         \
  F(DRAWARRAYS, DrawArrays)                                   \
  F(DRAWELEMENTS, DrawElements)                               \
  F(ENABLE, Enable)                                           \
  F(ENABLEVERTEXARRAYATTRIB, EnableVertexArrayAttrib)         \
  F(ENDQUERY, EndQuery)                                       \
  F(FENCESYNC, FenceSync)                                     \
  F(GENERATETEXTUREMIPMAP, GenerateTextureMipmap)             \
  F(GETERROR, GetError)                                       \
  F(GETGRAPHICSRESETSTATUS, GetGraphicsResetStatus)           \
  F(GETPROGRAMINFOLOG, GetProgramInfoLog)                     \
  F(GETPROGRAMIV, GetProgramiv)                               \
  F(GETQUERYOBJECTUI64V, GetQueryObjectui64v)                 \
  F(GETSHADERINFOLOG, GetShaderInfoLog)                       \
  F(GETSHADERIV, GetShaderiv)                                 \
  F(GETSTRING, GetString)                                     \
  F(GETUNIFORMLOCATION, GetUniformLocation)                   \
  F(LINKPROGRAM, LinkProgram)                                 \
  F(MAPNAMEDBUFFERRANGE, MapNamedBufferRange)                 \
  F(MEMORYBARRIER, MemoryBarrier)                             \
  F(NAMEDBUFFERSTORAGE, NamedBufferStorage)                   \
  F(NAMEDBUFFERSUBDATA, NamedBufferSubData)                   \
  F(NAMEDFRAMEBUFFERDRAWBUFFERS, NamedFramebufferDrawBuffers) \
  F(NAMEDFRAMEBUFFERREADBUFFER, NamedFramebufferReadBuffer)   \
  F(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture)         \
  F(PIXELSTOREI, PixelStorei)                                 \
  F(PROVOKINGVERTEX, ProvokingVertex)                         \
  F(PROGRAMUNIFORM1I, ProgramUniform1i)                       \
  F(PROGRAMUNIFORM1F, ProgramUniform1f)                       \
  F(PROGRAMUNIFORM1UI, ProgramUniform1ui)                     \
  F(PROGRAMUNIFORM2F, ProgramUniform2f)                       \
  F(PROGRAMUNIFORM2FV, ProgramUniform2fv)                     \
  F(PROGRAMUNIFORM3FV, ProgramUniform3fv)                     \
  F(PROGRAMUNIFORM4FV, ProgramUniform4fv)                     \
  F(PROGRAMUNIFORM4I, ProgramUniform4i)                       \
  F(READPIXELS, ReadPixels)                                   \
  F(SCISSOR, Scissor)                                         \
  F(SHADERSOURCE, ShaderSource)                               \
  F(TEXTUREPARAMETERI, TextureParameteri)                     \
  F(TEXTURESTORAGE2D, TextureStorage2D)                       \
  F(TEXTURESUBIMAGE2D, TextureSubImage2D)                     \
  F(USEPROGRAM, UseProgram)                                   \
  F(VERTEXARRAYATTRIBBINDING, VertexArrayAttribBinding)       \
  F(VERTEXARRAYATTRIBFORMAT, VertexArrayAttribFormat)         \
  F(VERTEXARRAYATTRIBIFORMAT, VertexArrayAttribIFormat)       \
  F(VERTEXARRAYELEMENTBUFFER, VertexArrayElementBuffer)       \
  F(VERTEXARRAYVERTEXBUFFER, VertexArrayVertexBuffer)         \
  F(VIEWPORT, Viewport)

/// Pointers to these functions, valid in the contexts of the display they were loaded from.
struct Functions {
#define HANDCAST_GL_MEMBER(type, name) PFNGL##type##PROC name = nullptr;
  HANDCAST_GL_FUNCTIONS(HANDCAST_GL_MEMBER)
#undef HANDCAST_GL_MEMBER
};

/// Finds an address by a function's full name; nullptr if there is none. eglGetProcAddress().
using FindFunction = void (*(*)(const char* name))();

/// Loads all functions. Errors (unavailable): one is missing.
Result<Functions> load_functions(FindFunction find);

/// What draws behind a context.
struct Gpu {
  std::string renderer;      ///< GL_RENDERER, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string version;       ///< GL_VERSION
  std::string platform;      ///< the EGL platform, e.g. "surfaceless"
  bool is_software = false;  ///< it draws on the processor

  /// E.g. "llvmpipe (LLVM 15.0.6, 256 bits), a software renderer".
  std::string sentence() const;
};

/// A context of OpenGL 4.5 core without a window, and the reason why it was lost. It may be used
/// by one thread at a time; it is current on that thread after make_current() until the thread
/// makes another one current.
class Context {
 public:
  /// Opens the first display of display_candidates() that has OpenGL 4.5 core. Errors
  /// (unavailable): no EGL, or no such display; the message has the reason of each. `shares`: opens
  /// the display of this share group instead, as one of its contexts.
  static Result<std::unique_ptr<Context>> open(const ShareGroup& shares = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes the context current on the calling thread. Returns false if it is lost.
  bool make_current();
  /// Releases the context from the calling thread.
  void release();

  /// Checks for a reset of the GPU and for errors of OpenGL. A context with an error counts as
  /// lost, because its images cannot be trusted.
  void check();
  /// Marks the context as lost. The first reason is kept.
  void lose(std::string reason);
  /// Why the context is lost; empty if it is not.
  const std::optional<std::string>& lost() const { return lost_; }

  /// The functions of OpenGL.
  const Functions& gl() const { return gl_; }
  /// What draws.
  const Gpu& gpu() const { return gpu_; }

 private:
  Context(const Egl& egl, EGLDisplay display, EGLContext context)
      : egl_(egl), display_(display), context_(context) {}
  static Result<std::unique_ptr<Context>> open(const Egl& egl, const DisplayCandidate& candidate,
                                               EGLContext shared);
  Result<void> load(const std::string& platform);

  Egl egl_;
  EGLDisplay display_;
  EGLContext context_;
  Functions gl_;
  Gpu gpu_;
  std::optional<std::string> lost_;
};

}  // namespace handcast::renderer::gl
