#include "viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <optional>

#include "viewer/ui_host.h"

namespace vantage {
namespace {

constexpr double kIdlePoll_s = 0.5;       ///< how often an idle window looks for new steps of its run
constexpr double kBusyPoll_s = 1.0 / 30;  ///< how often one does that plays or waits for work
constexpr double kLongestFrame_s = 0.25;  ///< a frame after a long sleep does not jump

using Clock = std::chrono::steady_clock;

/// What GLFW said last; it reports through a callback without context.
std::string& lastError() {
  static std::string text;
  return text;
}

[[noreturn]] void fail(const std::string& what) {
  const char* display = std::getenv("DISPLAY");
  std::string text = what;
  if (!lastError().empty()) text += " (" + lastError() + ")";
  if (!display || !*display) text += "; DISPLAY is not set";
  throw WindowUnavailable(text +
                          "; without a display use 'vantage view FILE --picture OUT.png' or 'vantage "
                          "snapshot', or run it under xvfb-run (package "
                          "xvfb); 'vantage doctor' says what OpenGL there is");
}

class GlfwContext final : public GlContext {
 public:
  explicit GlfwContext(GLFWwindow* window) : window_(window) {}
  void makeCurrent() override { glfwMakeContextCurrent(window_); }
  bool isCurrent() const override { return glfwGetCurrentContext() == window_; }
  std::string describe() const override { return "window"; }

 private:
  GLFWwindow* window_;
};

}  // namespace

struct Window::State {
  GLFWwindow* window = nullptr;
  std::unique_ptr<GlfwContext> context;
  std::unique_ptr<UiHost> host;
  WindowOptions options;
  Inspector* inspector = nullptr;
  int frames_wanted = 0;
  /// Keys that were pressed and not shown to Dear ImGui yet: it looks at keys once a frame, and a press may
  /// be over by then.
  struct Press {
    int key;    ///< by its label
    int place;  ///< as GLFW names it
    int mods;
  };
  std::deque<Press> presses;
  std::optional<Press> held;         ///< the key that is held down for it in this frame
  std::array<bool, 512> shown = {};  ///< keys that were down in the last frame

  /// The same for the mouse: a button counts where it was pressed or let go, however late the frame is.
  struct Click {
    int button;
    bool down;
    double x, y;
  };
  std::deque<Click> clicks;
  double cursor_x = 0.0, cursor_y = 0.0;  ///< as the events tell it; GLFW asks the display where it is now
  std::array<bool, 3> buttons = {};

  /// Dear ImGui takes some frames to come to rest after an event.
  void wantFrames() { frames_wanted = 3; }
  double pixelScale() const;
  double unitScale() const;
  void fitMonitor();
  void drawFrame(double elapsed_s);
  void showPress();
  void showClick();
};

namespace {

/// GLFW names keys by their places on an American keyboard; shortcuts go by what is written on them. Letters
/// of other alphabets stay where they are.
int keyByLabel(int key, int scancode) {
  if (key < 0 || key > GLFW_KEY_GRAVE_ACCENT) return key;  // it writes nothing, or is on the keypad
  const char* label = glfwGetKeyName(key, scancode);
  if (!label || label[0] == '\0' || label[1] != '\0') return key;
  if (label[0] >= 'a' && label[0] <= 'z') return label[0] - 'a' + GLFW_KEY_A;
  switch (label[0]) {
    case ',':
      return GLFW_KEY_COMMA;
    case '.':
      return GLFW_KEY_PERIOD;
    case '-':
      return GLFW_KEY_MINUS;
    case '=':
    case '+':
      return GLFW_KEY_EQUAL;
    default:
      return key;
  }
}

/// Every event asks for frames and goes on to Dear ImGui.
void watchEvents(GLFWwindow* window) {
  static constexpr auto wanted = [](GLFWwindow* w) {
    static_cast<Window::State*>(glfwGetWindowUserPointer(w))->wantFrames();
  };
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { wanted(w); });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { wanted(w); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    ImGui_ImplGlfw_WindowFocusCallback(w, focused);
    wanted(w);
  });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
    ImGui_ImplGlfw_CursorEnterCallback(w, entered);
    wanted(w);
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    auto* state = static_cast<Window::State*>(glfwGetWindowUserPointer(w));
    state->cursor_x = x;
    state->cursor_y = y;
    wanted(w);
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    auto* state = static_cast<Window::State*>(glfwGetWindowUserPointer(w));
    if (button >= 0 && button < static_cast<int>(state->buttons.size()))
      state->clicks.push_back({button, action == GLFW_PRESS, state->cursor_x, state->cursor_y});
    wanted(w);
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    ImGui_ImplGlfw_ScrollCallback(w, x, y);
    wanted(w);
  });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int place, int scancode, int action, int mods) {
    const int key = keyByLabel(place, scancode);
    ImGui_ImplGlfw_KeyCallback(w, key, scancode, action, mods);
    if (action == GLFW_PRESS && key >= 0)
      static_cast<Window::State*>(glfwGetWindowUserPointer(w))->presses.push_back({key, place, mods});
    wanted(w);
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned letter) {
    ImGui_ImplGlfw_CharCallback(w, letter);
    wanted(w);
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    auto* state = static_cast<Window::State*>(glfwGetWindowUserPointer(w));
    if (state->inspector) state->inspector->open({paths, paths + count});
    wanted(w);
  });
}

}  // namespace

Window::Window(const WindowOptions& options) : state_(std::make_unique<State>()) {
  state_->options = options;
  lastError().clear();
  glfwSetErrorCallback([](int, const char* message) { lastError() = message ? message : ""; });
  if (!glfwInit()) fail("no window: there is no usable display");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  // Forward compatibility is not asked for: lines would be one pixel wide.
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "Vantage");
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "vantage");
  state_->window = glfwCreateWindow(std::max(320, options.width), std::max(240, options.height),
                                    options.title.c_str(), nullptr, nullptr);
  if (!state_->window) {
    const std::string reason = lastError();
    glfwTerminate();
    lastError() = reason;
    fail("no window: OpenGL 3.2 is needed and the display does not offer it");
  }
  state_->fitMonitor();
  state_->context = std::make_unique<GlfwContext>(state_->window);
  state_->context->makeCurrent();
  glfwSwapInterval(1);
  state_->host = std::make_unique<UiHost>(*state_->context);
  state_->host->makeCurrent();
  glfwSetWindowUserPointer(state_->window, state_.get());
  ImGui_ImplGlfw_InitForOpenGL(state_->window, false);
  watchEvents(state_->window);
}

Window::~Window() {
  state_->host->makeCurrent();
  ImGui_ImplGlfw_Shutdown();
  state_->host.reset();
  glfwDestroyWindow(state_->window);
  glfwTerminate();
}

GlContext& Window::context() {
  return *state_->context;
}

void Window::wake() {
  glfwPostEmptyEvent();
}

void Window::copy(const std::string& utf8) {
  glfwSetClipboardString(state_->window, utf8.c_str());
}

int Window::width() const {
  int width = 0, height = 0;
  glfwGetWindowSize(state_->window, &width, &height);
  return static_cast<int>(std::lround(width / state_->unitScale()));
}

int Window::height() const {
  int width = 0, height = 0;
  glfwGetWindowSize(state_->window, &width, &height);
  return static_cast<int>(std::lround(height / state_->unitScale()));
}

void Window::State::showPress() {
  ImGuiIO& io = ImGui::GetIO();
  const auto down = [this](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
  if (held) io.KeysDown[held->key] = down(held->place);
  held.reset();
  io.KeyCtrl = down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL);
  io.KeyShift = down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT);
  if (!presses.empty()) {
    const Press press = presses.front();
    wantFrames();
    if (shown[press.key]) {
      io.KeysDown[press.key] = false;  // a second press needs a frame without the first
    } else {
      presses.pop_front();
      io.KeyCtrl |= (press.mods & GLFW_MOD_CONTROL) != 0;
      io.KeyShift |= (press.mods & GLFW_MOD_SHIFT) != 0;
      io.KeysDown[press.key] = true;
      held = press;
    }
  }
  std::copy(std::begin(io.KeysDown), std::end(io.KeysDown), shown.begin());
}

/// Pixels per unit of the window.
double Window::State::pixelScale() const {
  int in_units = 1, in_pixels = 1, ignored = 0;
  glfwGetWindowSize(window, &in_units, &ignored);
  glfwGetFramebufferSize(window, &in_pixels, &ignored);
  return static_cast<double>(in_pixels) / std::max(1, in_units);
}

/// How much larger than usual things must be in the window's units: the monitor's scale, where the unit is
/// the pixel.
double Window::State::unitScale() const {
  float scale_x = 1.0f, scale_y = 1.0f;
  glfwGetWindowContentScale(window, &scale_x, &scale_y);
  return std::max(1.0, scale_x / pixelScale());
}

/// A window that is larger than its monitor would hide its right and lower parts.
void Window::State::fitMonitor() {
  int left = 0, top = 0, most_width = 0, most_height = 0, width = 0, height = 0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return;
  glfwGetMonitorWorkarea(monitor, &left, &top, &most_width, &most_height);
  glfwGetWindowSize(window, &width, &height);
  if (most_width <= 0 || most_height <= 0 || (width <= most_width && height <= most_height)) return;
  glfwSetWindowSize(window, std::min(width, most_width), std::min(height, most_height));
  glfwSetWindowPos(window, left, top);
}

/// One change of a button a frame, at the place where it happened.
void Window::State::showClick() {
  ImGuiIO& io = ImGui::GetIO();
  if (!clicks.empty()) {
    const Click click = clicks.front();
    clicks.pop_front();
    buttons[click.button] = click.down;
    io.MousePos = {static_cast<float>(click.x), static_cast<float>(click.y)};
    wantFrames();
  }
  std::copy(buttons.begin(), buttons.end(), std::begin(io.MouseDown));
}

void Window::State::drawFrame(double elapsed_s) {
  int width = 1, height = 1;
  glfwGetFramebufferSize(window, &width, &height);
  if (width <= 0 || height <= 0) return;  // iconified
  const Preferences& preferences = inspector->preferences();
  host->setLook(preferences.theme, preferences.font_scale * unitScale());
  host->makeCurrent();
  ImGui_ImplGlfw_NewFrame();
  showPress();
  showClick();
  ImGui::GetIO().DeltaTime = static_cast<float>(elapsed_s);
  host->begin();
  inspector->draw(pixelScale());
  host->end(0, width, height);
  glfwSwapBuffers(window);
}

void Window::show(Inspector& inspector) {
  state_->inspector = &inspector;
  const auto start = Clock::now();
  auto last = start;
  state_->wantFrames();
  const std::stop_token& stop = state_->options.stop;
  while (!glfwWindowShouldClose(state_->window) && !inspector.wantsToClose() && !stop.stop_requested()) {
    if (state_->frames_wanted > 0)
      glfwPollEvents();
    else
      glfwWaitEventsTimeout(inspector.idle() ? kIdlePoll_s : kBusyPoll_s);
    const auto now = Clock::now();
    const double elapsed_s =
        std::clamp(std::chrono::duration<double>(now - last).count(), 1e-4, kLongestFrame_s);
    last = now;
    const double open_s = std::chrono::duration<double>(now - start).count();
    if (state_->options.quit_after_s > 0.0 && open_s > state_->options.quit_after_s) break;
    if (inspector.update(elapsed_s)) state_->wantFrames();
    if (state_->frames_wanted == 0) continue;
    --state_->frames_wanted;
    state_->drawFrame(elapsed_s);
  }
  state_->inspector = nullptr;
}

}  // namespace vantage
