// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/window.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "renderer/window/blit.hpp"
#include "renderer/window/glfw_library.hpp"
#include "renderer/window/idle_inhibitor.hpp"
#include "renderer/window/levels.hpp"
#include "renderer/window/share_group.hpp"
#include "renderer/window/x11.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kLookEvery_ns = 250'000'000;

/// The character, if it is one of ASCII.
std::string text_of(unsigned codepoint) {
  return codepoint < 128 ? std::string(1, static_cast<char>(codepoint)) : std::string();
}

}  // namespace

Result<std::vector<Monitor>> list_monitors() {
  const auto library = GlfwLibrary::open();
  if (!library) return tl::make_unexpected(library.error());
  return (*library)->monitors().monitors;
}

class Window::Screen {
 public:
  Screen(std::unique_ptr<GlfwLibrary> library, WindowSettings settings)
      : library_(std::move(library)), settings_(std::move(settings)) {}
  ~Screen() {
    if (window_ != nullptr) glfwMakeContextCurrent(window_);
    levels_.reset();
    blit_.reset();
    if (window_ != nullptr) glfwDestroyWindow(window_);
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  Result<void> create();
  /// Shows what `draw` draws to a back buffer of the size that it gets.
  template <class Draw>
  Result<Shown> show(const Draw& draw);
  Blit& blit() { return *blit_; }
  LevelsShader& levels() { return *levels_; }
  ShareGroup share_group() const {
    return levels_->works() ? share_group_of(window_) : ShareGroup();
  }
  std::optional<Monitor> monitor() const { return found_; }
  std::optional<std::int64_t> refresh_ns() const;
  std::vector<std::string> take_keys() { return std::exchange(keys_, {}); }
  std::vector<PointerEvent> take_pointer() { return std::exchange(pointer_, {}); }
  bool is_closed() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
  std::pair<int, int> size_px() const;

 private:
  Result<void> find_monitor();
  Result<void> create_window();
  void watch_monitors();
  void keep_awake();
  void listen();
  void note(PointerEvent::Kind kind);
  void warm_up();
  void appear();
  bool covers_monitor() const;
  void keep_in_front();

  std::unique_ptr<GlfwLibrary> library_;
  WindowSettings settings_;
  GLFWwindow* window_ = nullptr;
  GLFWmonitor* monitor_ = nullptr;  ///< of a full-screen window, while it is plugged in
  std::optional<IdleInhibitor> inhibitor_;
  std::optional<Monitor> found_;  ///< how it was found last
  double rate_hz_ = 0;            ///< of the monitor; 0: unknown
  std::unique_ptr<Blit> blit_;
  std::unique_ptr<LevelsShader> levels_;
  bool has_appeared_ = false;
  std::int64_t next_look_ns_ = 0;  ///< when to look again whether the window covers the monitor
  std::vector<std::string> keys_;
  std::vector<PointerEvent> pointer_;
  std::pair<double, double> cursor_;  ///< where the mouse was last, px
  bool is_pressed_ = false;

  static Screen* the_screen_;  ///< GLFW reports monitors without a window
};

Window::Screen* Window::Screen::the_screen_ = nullptr;

/// Finds the monitor of a full-screen window: the one in the settings, or the one it was on before.
Result<void> Window::Screen::find_monitor() {
  const auto [handles, monitors] = library_->monitors();
  const auto chosen = choose_monitor(
      monitors, settings_.monitor.empty() && found_ ? found_->output : settings_.monitor);
  if (!chosen) return tl::make_unexpected(chosen.error());
  monitor_ = handles[*chosen];
  found_ = monitors[*chosen];
  return {};
}

/// Creates the hidden window with its context.
Result<void> Window::Screen::create_window() {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, settings_.full_screen ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  // A painter on the GPU uses EGL, and a thread cannot change between EGL and GLX.
  for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
    if (window_ != nullptr) break;
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    window_ = glfwCreateWindow(settings_.width_px, settings_.height_px, settings_.title.c_str(),
                               nullptr, nullptr);
  }
  if (window_ == nullptr)
    return fail(Errc::unavailable,
                fmt::format("no window can be opened: {}", GlfwLibrary::last_reason()));
  return {};
}

Result<void> Window::Screen::create() {
  if (settings_.full_screen)
    if (auto found = find_monitor(); !found) return found;
  x11::when_display_is_lost(settings_.when_display_is_lost);

  if (auto made = create_window(); !made) return made;
  if (settings_.full_screen) glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(settings_.vsync ? 1 : 0);
  blit_ = std::make_unique<Blit>();
  levels_ = std::make_unique<LevelsShader>();
  warm_up();

  listen();
  watch_monitors();
  if (settings_.keeps_awake) keep_awake();
  return {};
}

/// The X server has timers of its own; those of a desktop know nothing of them.
void Window::Screen::keep_awake() {
  if (!x11::keep_awake())
    log::warning(
        "the X server's screen saver cannot be suspended; `xset s off -dpms` switches it off");
  auto inhibitor = IdleInhibitor::open("light on hands");
  if (inhibitor)
    inhibitor_.emplace(std::move(*inhibitor));
  else
    log::info("no desktop was asked to stay awake: {}", inhibitor.error().what);
}

/// Hides the window while its monitor is unplugged.
void Window::Screen::watch_monitors() {
  the_screen_ = this;
  glfwSetMonitorCallback([](GLFWmonitor* monitor, int event) {
    if (event != GLFW_DISCONNECTED || monitor != the_screen_->monitor_) return;
    log::warning("monitor '{}' is unplugged", the_screen_->found_->output);
    the_screen_->monitor_ = nullptr;
    glfwHideWindow(the_screen_->window_);  // GLFW would leave it on the operator's screen
    the_screen_->has_appeared_ = false;
  });
}

/// Takes the events of keyboard and mouse.
void Window::Screen::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned codepoint) {
    static_cast<Screen*>(glfwGetWindowUserPointer(window))->keys_.push_back(text_of(codepoint));
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS)
      static_cast<Screen*>(glfwGetWindowUserPointer(window))->keys_.emplace_back("Escape");
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
    if (button != GLFW_MOUSE_BUTTON_LEFT) return;
    auto& screen = *static_cast<Screen*>(glfwGetWindowUserPointer(window));
    screen.is_pressed_ = action == GLFW_PRESS;
    screen.note(screen.is_pressed_ ? PointerEvent::Kind::press : PointerEvent::Kind::release);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    auto& screen = *static_cast<Screen*>(glfwGetWindowUserPointer(window));
    screen.cursor_ = {x, y};
    if (screen.is_pressed_) screen.note(PointerEvent::Kind::move);
  });
}

/// Keeps an event of the mouse at its last place. Few are kept if nobody takes them.
void Window::Screen::note(PointerEvent::Kind kind) {
  constexpr std::size_t kMost = 4096;
  if (pointer_.size() < kMost) pointer_.push_back({kind, cursor_.first, cursor_.second});
}

/// Draws a picture that nobody sees: drivers compile their programs and take memory for the first
/// one, which takes 50 ms with llvmpipe.
void Window::Screen::warm_up() {
  const Image<std::uint32_t> black(settings_.width_px, settings_.height_px);
  const GLFWvidmode* mode = monitor_ != nullptr ? glfwGetVideoMode(monitor_) : nullptr;
  const int width = mode != nullptr ? mode->width : settings_.width_px,
            height = mode != nullptr ? mode->height : settings_.height_px;
  blit_->draw(black.view(), {0, 0, black.width(), black.height()}, width, height);
  blit_->finish();
}

/// Puts the window on its monitor. The monitor keeps its video mode, because another one may not
/// fit into the screen of the server, which ends the process that asks for it.
void Window::Screen::appear() {
  has_appeared_ = true;
  const GLFWvidmode* mode = glfwGetVideoMode(monitor_ ? monitor_ : glfwGetPrimaryMonitor());
  rate_hz_ = mode != nullptr ? mode->refreshRate : 0;
  if (!settings_.full_screen) return glfwShowWindow(window_);
  if (mode == nullptr) return;
  const int width = mode->width, height = mode->height;
  glfwSetWindowMonitor(window_, monitor_, 0, 0, width, height, mode->refreshRate);
  log::info("light on monitor '{}', {}x{} at {} Hz", found_->output, width, height, rate_hz_);
  if (width != settings_.width_px || height != settings_.height_px)
    log::warning(
        "monitor '{0}' has {1}x{2} pixels and the calibration {3}x{4}, so the picture is scaled; "
        "`xrandr --output {0} --mode {3}x{4}` may change it",
        found_->output, width, height, settings_.width_px, settings_.height_px);
}

bool Window::Screen::covers_monitor() const {
  const GLFWvidmode* mode = glfwGetVideoMode(monitor_);
  if (mode == nullptr) return true;
  int x = 0, y = 0, width = 0, height = 0, monitor_x = 0, monitor_y = 0;
  glfwGetMonitorPos(monitor_, &monitor_x, &monitor_y);
  glfwGetWindowPos(window_, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  return glfwGetWindowAttrib(window_, GLFW_VISIBLE) == GLFW_TRUE && x == monitor_x &&
         y == monitor_y && width == mode->width && height == mode->height;
}

/// Undoes what a user or another program did to a full-screen window.
void Window::Screen::keep_in_front() {
  if (!settings_.full_screen) return;
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) glfwRestoreWindow(window_);
  glfwSetWindowShouldClose(window_, GLFW_FALSE);
  if (now_ns() < next_look_ns_) return;  // it takes the server some time
  next_look_ns_ = now_ns() + kLookEvery_ns;
  if (covers_monitor()) return;
  log::warning("another program moved, resized or hid the window on monitor '{}'; it is put back",
               found_->output);
  glfwSetWindowMonitor(window_, nullptr, 0, 0, settings_.width_px, settings_.height_px, 0);
  appear();
}

/// The context is made current each time: a painter on the same thread has one of its own.
template <class Draw>
Result<Shown> Window::Screen::show(const Draw& draw) {
  glfwPollEvents();
  glfwMakeContextCurrent(window_);
  if (settings_.full_screen && monitor_ == nullptr) {
    if (!find_monitor())
      return fail(Errc::timeout, fmt::format("monitor '{}' is unplugged", found_->output));
    log::info("monitor '{}' is there again", found_->output);
  }
  if (!has_appeared_) appear();
  keep_in_front();
  const auto [width, height] = size_px();
  draw(width, height);
  const std::int64_t handed_ns = now_ns();
  glfwSwapBuffers(window_);
  blit_->finish();
  return Shown{handed_ns, now_ns()};
}

std::optional<std::int64_t> Window::Screen::refresh_ns() const {
  if (!settings_.vsync || rate_hz_ <= 0) return {};
  return static_cast<std::int64_t>(1e9 / rate_hz_);
}

std::pair<int, int> Window::Screen::size_px() const {
  std::pair<int, int> size;
  glfwGetFramebufferSize(window_, &size.first, &size.second);
  return size;
}

Window::Window(std::unique_ptr<Screen> screen) : screen_(std::move(screen)) {}
Window::~Window() = default;

Result<std::unique_ptr<Window>> Window::open(WindowSettings settings) {
  auto library = GlfwLibrary::open();
  if (!library) return tl::make_unexpected(library.error());
  auto screen = std::make_unique<Screen>(std::move(*library), std::move(settings));
  if (auto created = screen->create(); !created) return tl::make_unexpected(created.error());
  return std::unique_ptr<Window>(new Window(std::move(screen)));
}

Result<Shown> Window::show(View<const std::uint32_t> picture, Rect region) {
  return screen_->show(
      [&](int width, int height) { screen_->blit().draw(picture, region, width, height); });
}
Result<Shown> Window::show(const DeviceImage& image, Rect region, const LightTable& table) {
  return screen_->show(
      [&](int width, int height) { screen_->levels().draw(image, region, table, width, height); });
}
ShareGroup Window::share_group() const { return screen_->share_group(); }
std::optional<Monitor> Window::monitor() const { return screen_->monitor(); }
std::optional<std::int64_t> Window::refresh_ns() const { return screen_->refresh_ns(); }
std::vector<std::string> Window::take_keys() { return screen_->take_keys(); }
std::vector<PointerEvent> Window::take_pointer() { return screen_->take_pointer(); }
bool Window::is_closed() const { return screen_->is_closed(); }
int Window::width_px() const { return screen_->size_px().first; }
int Window::height_px() const { return screen_->size_px().second; }

}  // namespace handcast::renderer
