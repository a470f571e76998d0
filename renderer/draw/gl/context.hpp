// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/base/device_image.hpp"
#include "renderer/draw/gl/egl.hpp"
#include "renderer/draw/gl/functions.hpp"

namespace handcast::renderer::gl {

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
