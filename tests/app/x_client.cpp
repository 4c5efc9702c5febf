// What a desktop does to a window, for tests under a bare X server: `x_client dpi N` tells programs that are
// started later how fine the display is; `x_client drop FILE...` drags files onto the window that takes them
// (XDND); `x_client ctrl KEY` presses a key with Ctrl in that window.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/keysym.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr long kXdndVersion = 5;
constexpr auto kPatience = std::chrono::seconds(10);

/// The window that says that it takes files; none: None.
Window findAware(Display* display, Window window, Atom aware) {
  Atom type = None;
  int format = 0;
  unsigned long count = 0, left = 0;
  unsigned char* data = nullptr;
  XGetWindowProperty(display, window, aware, 0, 1, False, AnyPropertyType, &type, &format, &count, &left,
                     &data);
  if (data) XFree(data);
  if (count > 0) return window;
  Window root = None, parent = None, *children = nullptr, found = None;
  unsigned n = 0;
  if (!XQueryTree(display, window, &root, &parent, &children, &n)) return None;
  for (unsigned i = 0; i < n && found == None; ++i) found = findAware(display, children[i], aware);
  if (children) XFree(children);
  return found;
}

/// Calls `done` for every event until it says true.
void await(Display* display, const char* what, const std::function<bool(XEvent&)>& done) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    while (XPending(display) > 0) {
      XEvent event;
      XNextEvent(display, &event);
      if (done(event)) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw std::runtime_error(std::string("the window sent no ") + what);
}

/// One drag, from a window of its own that is never shown.
class Drag {
 public:
  Drag(Display* display, const std::vector<std::string>& files) : display_(display) {
    for (const std::string& file : files)
      uris_ += "file://" + std::filesystem::absolute(file).string() + "\r\n";
    target_ = findAware(display, DefaultRootWindow(display), atom("XdndAware"));
    if (target_ == None) throw std::runtime_error("no window takes files");
    source_ = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display, atom("XdndSelection"), source_, CurrentTime);
  }

  void drop() {
    send("XdndEnter", {kXdndVersion << 24, static_cast<long>(atom("text/uri-list")), None, None});
    const long middle = (640l << 16) | 400l;
    send("XdndPosition", {0, middle, CurrentTime, static_cast<long>(atom("XdndActionCopy"))});
    await(display_, "XdndStatus", [&](XEvent& event) { return isMessage(event, "XdndStatus"); });
    send("XdndDrop", {0, CurrentTime, 0, 0});
    await(display_, "XdndFinished", [&](XEvent& event) {
      if (event.type == SelectionRequest) give(event.xselectionrequest);
      return isMessage(event, "XdndFinished");
    });
  }

 private:
  Atom atom(const char* name) { return XInternAtom(display_, name, False); }
  bool isMessage(const XEvent& event, const char* name) {
    return event.type == ClientMessage && event.xclient.message_type == atom(name);
  }
  void send(const char* name, const std::vector<long>& data) {
    XEvent event = {};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(name);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(source_);
    for (std::size_t i = 0; i < data.size(); ++i) event.xclient.data.l[i + 1] = data[i];
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }
  /// Answers who asks for what is dragged.
  void give(const XSelectionRequestEvent& asked) {
    XChangeProperty(display_, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
    XEvent answer = {};
    answer.xselection = {.type = SelectionNotify,
                         .serial = 0,
                         .send_event = True,
                         .display = display_,
                         .requestor = asked.requestor,
                         .selection = asked.selection,
                         .target = asked.target,
                         .property = asked.property,
                         .time = asked.time};
    XSendEvent(display_, asked.requestor, False, NoEventMask, &answer);
    XFlush(display_);
  }

  Display* display_;
  Window source_ = None, target_ = None;
  std::string uris_;
};

void pressWithCtrl(Display* display, const std::string& key) {
  const Window target =
      findAware(display, DefaultRootWindow(display), XInternAtom(display, "XdndAware", False));
  if (target == None) throw std::runtime_error("there is no window");
  const auto send = [&](KeySym symbol, int type, unsigned state) {
    XEvent event = {};
    event.xkey.type = type;
    event.xkey.window = target;
    event.xkey.root = DefaultRootWindow(display);
    event.xkey.same_screen = True;
    event.xkey.state = state;
    event.xkey.keycode = XKeysymToKeycode(display, symbol);
    XSendEvent(display, target, True, type == KeyPress ? KeyPressMask : KeyReleaseMask, &event);
    XSync(display, False);
  };
  const KeySym symbol = XStringToKeysym(key.c_str());
  send(XK_Control_L, KeyPress, 0);
  send(symbol, KeyPress, ControlMask);
  send(symbol, KeyRelease, ControlMask);
  send(XK_Control_L, KeyRelease, ControlMask);
}

void setDpi(Display* display, const std::string& dpi) {
  const std::string resources = "Xft.dpi:\t" + dpi + "\n";
  XChangeProperty(display, DefaultRootWindow(display), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(resources.data()),
                  static_cast<int>(resources.size()));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2 || (words[0] != "dpi" && words[0] != "drop" && words[0] != "ctrl")) {
    std::fputs("usage: x_client dpi N | drop FILE... | ctrl KEY\n", stderr);
    return 1;
  }
  Display* display = XOpenDisplay(nullptr);
  if (!display) {
    std::fputs("x_client: no display\n", stderr);
    return 3;
  }
  try {
    if (words[0] == "dpi")
      setDpi(display, words[1]);
    else if (words[0] == "ctrl")
      pressWithCtrl(display, words[1]);
    else
      Drag(display, {words.begin() + 1, words.end()}).drop();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "x_client: %s\n", error.what());
    return 1;
  }
  XCloseDisplay(display);
}
