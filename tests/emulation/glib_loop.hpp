// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glib.h>

#include <thread>

namespace handcast::test {

/// A main loop of GLib in a thread of its own, in which umockdev answers the calls of a device.
class GlibLoop {
 public:
  GlibLoop() = default;
  GlibLoop(const GlibLoop&) = delete;
  GlibLoop& operator=(const GlibLoop&) = delete;
  ~GlibLoop() {
    stop();
    g_main_loop_unref(loop_);
    g_main_context_unref(context_);
  }

  /// For sources that belong to this loop.
  GMainContext* context() const { return context_; }

  /// Calls `make`; the sources that it creates belong to this loop.
  template <class Make>
  void with(Make make) const {
    g_main_context_push_thread_default(context_);
    make();
    g_main_context_pop_thread_default(context_);
  }

  /// Runs the loop until stop().
  void start() {
    thread_ = std::thread([this] { with([this] { g_main_loop_run(loop_); }); });
  }

  /// Ends the loop and waits for its thread. Does nothing if it is not running.
  void stop() {
    if (!thread_.joinable()) return;
    // Quits from inside the loop: g_main_loop_quit() has no effect before g_main_loop_run() has
    // begun, and the loop would never end.
    auto* quit = g_idle_source_new();
    g_source_set_callback(quit, quit_from_within, loop_, nullptr);
    g_source_attach(quit, context_);
    g_source_unref(quit);
    thread_.join();
  }

 private:
  static gboolean quit_from_within(gpointer loop) {
    g_main_loop_quit(static_cast<GMainLoop*>(loop));
    return G_SOURCE_REMOVE;
  }

  GMainContext* context_ = g_main_context_new();
  GMainLoop* loop_ = g_main_loop_new(context_, FALSE);
  std::thread thread_;
};

}  // namespace handcast::test
