// SPDX-License-Identifier: Apache-2.0
#include "tests/renderer/window/screen_reader.hpp"

#include <X11/Xatom.h>
#include <X11/Xutil.h>
#include <X11/extensions/Xrandr.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/renderer/output/edid_block.hpp"

namespace handcast::test {
namespace {

struct Close {
  void operator()(Display* display) const { XCloseDisplay(display); }
};
using Connection = std::unique_ptr<Display, Close>;

Connection connect() { return Connection(XOpenDisplay(nullptr)); }

std::vector<Window> shown_windows(const Connection& display) {
  Window root = 0, parent = 0, *windows = nullptr;
  unsigned count = 0;
  std::vector<Window> shown;
  if (!XQueryTree(display.get(), DefaultRootWindow(display.get()), &root, &parent, &windows,
                  &count))
    return shown;
  for (unsigned i = 0; i < count; ++i) {
    XWindowAttributes state{};
    if (XGetWindowAttributes(display.get(), windows[i], &state) && state.map_state == IsViewable)
      shown.push_back(windows[i]);
  }
  if (windows != nullptr) XFree(windows);
  return shown;
}

/// Those with this title; all if it is empty.
std::vector<Window> titled_windows(const Connection& display, std::string_view title) {
  auto windows = shown_windows(display);
  std::erase_if(windows, [&](Window window) {
    char* name = nullptr;
    const bool has_name = XFetchName(display.get(), window, &name) != 0 && name != nullptr;
    const bool is_other = !title.empty() && (!has_name || title != name);
    if (has_name) XFree(name);
    return is_other;
  });
  return windows;
}

}  // namespace

std::uint32_t pixel(int x, int y) {
  const auto display = connect();
  XImage* image =
      XGetImage(display.get(), DefaultRootWindow(display.get()), x, y, 1, 1, AllPlanes, ZPixmap);
  if (image == nullptr) return 0;
  const auto rgb = static_cast<std::uint32_t>(XGetPixel(image, 0, 0));
  XDestroyImage(image);
  return 0xff000000u | (rgb & 0xff) << 16 | (rgb & 0xff00) | (rgb >> 16 & 0xff);
}

int lit_pixels(int left, int top, int width, int height) {
  const auto display = connect();
  XImage* image =
      XGetImage(display.get(), DefaultRootWindow(display.get()), left, top,
                static_cast<unsigned>(width), static_cast<unsigned>(height), AllPlanes, ZPixmap);
  if (image == nullptr) return 0;
  int lit = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) lit += (XGetPixel(image, x, y) & 0xffffff) != 0 ? 1 : 0;
  XDestroyImage(image);
  return lit;
}

bool shows_a_window() {
  const auto display = connect();
  return !shown_windows(display).empty();
}

bool shows_a_window(std::string_view title) {
  const auto display = connect();
  return !titled_windows(display, title).empty();
}

void resize_windows(int width, int height) {
  const auto display = connect();
  for (const auto window : shown_windows(display))
    XResizeWindow(display.get(), window, static_cast<unsigned>(width),
                  static_cast<unsigned>(height));
  XSync(display.get(), False);
}

void hide_windows() {
  const auto display = connect();
  for (const auto window : shown_windows(display)) XUnmapWindow(display.get(), window);
  XSync(display.get(), False);
}

void drag_in_window(int from_x, int from_y, int to_x, int to_y, std::string_view title) {
  const auto display = connect();
  const auto windows = titled_windows(display, title);
  if (windows.empty()) return;
  const auto send = [&](int type, long mask, int x, int y) {
    XEvent event{};
    event.type = type;
    event.xbutton.window = windows.back();
    event.xbutton.root = DefaultRootWindow(display.get());
    event.xbutton.same_screen = True;
    event.xbutton.x = x;  // at the same place in XMotionEvent
    event.xbutton.y = y;
    if (type != MotionNotify) event.xbutton.button = Button1;
    XSendEvent(display.get(), windows.back(), False, mask, &event);
  };
  send(MotionNotify, PointerMotionMask, from_x, from_y);
  send(ButtonPress, ButtonPressMask, from_x, from_y);
  send(MotionNotify, PointerMotionMask, to_x, to_y);
  send(ButtonRelease, ButtonReleaseMask, to_x, to_y);
  send(MotionNotify, PointerMotionMask, from_x, from_y);
  XSync(display.get(), False);
}

void paint_the_desktop(unsigned long rgb) {
  const auto display = connect();
  XSetWindowBackground(display.get(), DefaultRootWindow(display.get()), rgb);
  XClearWindow(display.get(), DefaultRootWindow(display.get()));
  XSync(display.get(), False);
}

void set_edid_name(std::string_view output, std::string_view name) {
  const auto edid = edid_with(std::string(name) + '\n');
  const auto display = connect();
  auto* resources = XRRGetScreenResourcesCurrent(display.get(), DefaultRootWindow(display.get()));
  const Atom property = XInternAtom(display.get(), RR_PROPERTY_RANDR_EDID, False);
  for (int i = 0; i < resources->noutput; ++i) {
    auto* info = XRRGetOutputInfo(display.get(), resources, resources->outputs[i]);
    if (output == info->name)
      XRRChangeOutputProperty(display.get(), resources->outputs[i], property, XA_INTEGER, 8,
                              PropModeReplace, edid.data(), edid.size());
    XRRFreeOutputInfo(info);
  }
  XRRFreeScreenResources(resources);
  XSync(display.get(), False);
}

}  // namespace handcast::test
