#include "core/gpu/egl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "core/gpu/driver_messages.h"

namespace vantage {
namespace {

constexpr unsigned kGlVendor = 0x1F00, kGlRenderer = 0x1F01, kGlVersion = 0x1F02;

/// Whole-word search in a list of extensions.
bool lists(const char* extensions, std::string_view name) {
  if (!extensions) return false;
  std::string_view rest = extensions;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::string eglReason(const char* call) {
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(), "%s failed (0x%04x)", call, static_cast<unsigned>(eglGetError()));
  return text.data();
}

template <class F>
F eglFunction(const char* name) {
  return reinterpret_cast<F>(eglGetProcAddress(name));
}

/// A display that might work.
struct Candidate {
  std::string platform;
  EGLDisplay display = EGL_NO_DISPLAY;
  bool software = false;
  bool pixel_buffer = false;  ///< needs a surface to be current
};

std::vector<Candidate> deviceCandidates(const char* client_extensions) {
  std::vector<Candidate> found;
  const auto query_devices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_string = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const auto get_display = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (!query_devices || !get_display || !lists(client_extensions, "EGL_EXT_platform_device")) return found;
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (!query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count)) return found;
  for (EGLint i = 0; i < count; ++i) {
    Candidate candidate;
    candidate.software =
        query_string && lists(query_string(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
    candidate.platform = "device " + std::to_string(i) + (candidate.software ? " (software)" : "");
    candidate.display = get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    found.push_back(candidate);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.software < b.software; });
  return found;
}

std::vector<Candidate> candidates(const char* client_extensions) {
  std::vector<Candidate> all = deviceCandidates(client_extensions);
  const auto get_display = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display && lists(client_extensions, "EGL_MESA_platform_surfaceless")) {
    all.push_back({"surfaceless", get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                   true, false});
  }
  all.push_back({"pbuffer", eglGetDisplay(EGL_DEFAULT_DISPLAY), false, true});
  return all;
}

GlFailure machineFacts(const char* client_extensions) {
  namespace fs = std::filesystem;
  GlFailure facts;
  std::error_code ignored;
  facts.vendor_library = client_extensions && std::strstr(client_extensions, "EGL_EXT_platform_") != nullptr;
  facts.nvidia_device =
      fs::exists("/dev/nvidiactl", ignored) || fs::exists("/proc/driver/nvidia/version", ignored);
  for (const char* folder : {"/usr/share/glvnd/egl_vendor.d", "/etc/glvnd/egl_vendor.d"}) {
    for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end; it.increment(ignored)) {
      if (it->path().filename().string().find("nvidia") != std::string::npos) facts.nvidia_vendor_file = true;
    }
  }
  return facts;
}

std::string oneLine(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) text.replace(at, 1, " | ");
  return text;
}

std::string failureText(const GlFailure& failure) {
  std::string text = "OpenGL: no context without a display";
  const char* separator = " (";
  for (const GlAttempt& attempt : failure.attempts) {
    text += separator + attempt.platform + ": " + attempt.reason;
    separator = ", ";
  }
  if (!failure.attempts.empty()) text += ")";
  if (!failure.driver_messages.empty()) text += " [" + oneLine(failure.driver_messages) + "]";
  return text + "; " + adviseOnGl(failure);
}

}  // namespace

std::string adviseOnGl(const GlFailure& failure) {
  const auto said = [&](const char* words) {
    return failure.driver_messages.find(words) != std::string::npos;
  };
  if (said("GLIBCXX_")) {
    return "another libstdc++ comes first on the library path: take its folder out of LD_LIBRARY_PATH";
  }
  if (failure.nvidia_device && !failure.nvidia_vendor_file) {
    return "an NVIDIA driver without its EGL vendor file: start the container with "
           "NVIDIA_DRIVER_CAPABILITIES=all, or add "
           "/usr/share/glvnd/egl_vendor.d/10_nvidia.json, or install libegl-mesa0 and libgl1-mesa-dri to "
           "draw in software";
  }
  if (!failure.vendor_library) return "no EGL vendor library was found: install libegl-mesa0";
  return "no driver could be loaded: install libgl1-mesa-dri";
}

GlUnavailable::GlUnavailable(GlFailure failure)
    : std::runtime_error(failureText(failure)), failure_(std::move(failure)) {}

struct EglContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  std::vector<GlAttempt> attempts;
  std::string driver_messages, description;

  // The display stays initialised: contexts of one device share it, and eglTerminate() would end them all.
  void destroy() {
    if (display == EGL_NO_DISPLAY) return;
    if (context != EGL_NO_CONTEXT && eglGetCurrentContext() == context) {
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    surface = EGL_NO_SURFACE;
    context = EGL_NO_CONTEXT;
  }

  /// Empty if the context is there and current, else what failed.
  std::string open(const Candidate& candidate, int major, int minor);
  void describeCurrent(const std::string& platform, int egl_major, int egl_minor);
};

void EglContext::State::describeCurrent(const std::string& platform, int egl_major, int egl_minor) {
  const auto get_string = eglFunction<const unsigned char* (*)(unsigned)>("glGetString");
  const auto text = [&](unsigned name) {
    const unsigned char* value = get_string ? get_string(name) : nullptr;
    return std::string(value ? reinterpret_cast<const char*>(value) : "?");
  };
  description = "EGL " + std::to_string(egl_major) + "." + std::to_string(egl_minor) + " " + platform +
                ", OpenGL " + text(kGlVersion) + ", " + text(kGlRenderer) + " (" + text(kGlVendor) + ")";
}

std::string EglContext::State::open(const Candidate& candidate, int major, int minor) {
  display = candidate.display;
  if (display == EGL_NO_DISPLAY) return eglReason("no display: eglGetPlatformDisplay");
  EGLint egl_major = 0, egl_minor = 0;
  if (!eglInitialize(display, &egl_major, &egl_minor)) return eglReason("eglInitialize");
  if (!eglBindAPI(EGL_OPENGL_API)) return eglReason("eglBindAPI");
  const EGLint config_wanted[] = {EGL_SURFACE_TYPE,
                                  EGL_PBUFFER_BIT,
                                  EGL_RENDERABLE_TYPE,
                                  EGL_OPENGL_BIT,
                                  EGL_RED_SIZE,
                                  8,
                                  EGL_GREEN_SIZE,
                                  8,
                                  EGL_BLUE_SIZE,
                                  8,
                                  EGL_ALPHA_SIZE,
                                  8,
                                  EGL_DEPTH_SIZE,
                                  24,
                                  EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  if (!eglChooseConfig(display, config_wanted, &config, 1, &configs) || configs == 0)
    return eglReason("eglChooseConfig");
  const EGLint context_wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                   major,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   minor,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_NONE};
  context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wanted);
  if (context == EGL_NO_CONTEXT) {
    return eglReason(
        ("OpenGL " + std::to_string(major) + "." + std::to_string(minor) + ": eglCreateContext").c_str());
  }
  if (candidate.pixel_buffer ||
      !lists(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
    const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size);
    if (surface == EGL_NO_SURFACE) return eglReason("eglCreatePbufferSurface");
  }
  if (!eglMakeCurrent(display, surface, surface, context)) return eglReason("eglMakeCurrent");
  describeCurrent(candidate.platform, egl_major, egl_minor);
  return {};
}

EglContext::EglContext(int major, int minor) : state_(std::make_unique<State>()) {
  DriverMessages messages;
  const char* client_extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  for (const Candidate& candidate : candidates(client_extensions)) {
    const std::string reason = state_->open(candidate, major, minor);
    state_->attempts.push_back({candidate.platform, reason});
    if (reason.empty()) {
      state_->driver_messages = messages.finish();
      return;
    }
    state_->destroy();
  }
  GlFailure failure = machineFacts(client_extensions);
  failure.attempts = state_->attempts;
  failure.driver_messages = messages.finish();
  throw GlUnavailable(std::move(failure));
}

EglContext::~EglContext() {
  state_->destroy();
}

void EglContext::makeCurrent() {
  if (isCurrent()) return;
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(state_->display, state_->surface, state_->surface, state_->context)) {
    throw std::runtime_error("OpenGL: " + eglReason("eglMakeCurrent") +
                             "; the context is lost or in use by another thread");
  }
}

bool EglContext::isCurrent() const {
  return eglGetCurrentContext() == state_->context;
}
std::string EglContext::describe() const {
  return state_->description;
}
void EglContext::release() {
  if (isCurrent()) eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}
void* EglContext::function(const char* name) const {
  return reinterpret_cast<void*>(eglGetProcAddress(name));
}
const std::vector<GlAttempt>& EglContext::attempts() const {
  return state_->attempts;
}
const std::string& EglContext::driverMessages() const {
  return state_->driver_messages;
}

}  // namespace vantage
