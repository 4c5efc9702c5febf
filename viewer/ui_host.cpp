#include <GL/glew.h>
// GLEW comes before everything that includes OpenGL headers.
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "viewer/ui_host.h"

namespace vantage {
namespace {

constexpr double kFont_px = 15.0;  ///< at scale 1

/// Loads OpenGL's functions. Debian's GLEW reports a missing GLX display under EGL after it has loaded them.
void loadFunctions() {
  glewExperimental = GL_TRUE;
  const GLenum result = glewInit();
  if (result != GLEW_OK && result != GLEW_ERROR_NO_GLX_DISPLAY)
    throw std::runtime_error("OpenGL: " +
                             std::string(reinterpret_cast<const char*>(glewGetErrorString(result))));
  if (!GLEW_VERSION_3_2)
    throw std::runtime_error(
        "OpenGL 3.2 is needed, and the driver has less; update it, or use Mesa's software driver "
        "(LIBGL_ALWAYS_SOFTWARE=1)");
}

/// Latin, Greek, arrows, mathematical signs, blocks and geometric shapes.
const ImWchar* glyphRanges() {
  static const ImWchar kRanges[] = {0x0020, 0x017f, 0x0370, 0x03ff, 0x2010, 0x2044, 0x2070, 0x209f, 0x2190,
                                    0x21ff, 0x2200, 0x22ff, 0x25a0, 0x25ff, 0x2713, 0x2717, 0};
  return kRanges;
}

/// The font of the package fonts-dejavu-core, else the one that Dear ImGui brings, which has plain letters
/// only.
void buildFont(ImFontAtlas& atlas, double font_px) {
  constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  atlas.Clear();
  ImFontConfig config;
  config.OversampleH = 2;
  const auto size = static_cast<float>(std::round(font_px));
  std::error_code error;
  if (std::filesystem::exists(kFont, error) && atlas.AddFontFromFileTTF(kFont, size, &config, glyphRanges()))
    return;
  config.SizePixels = size;
  atlas.AddFontDefault(&config);
}

}  // namespace

struct UiHost::State {
  GlContext& gl;
  ImGuiContext* ui = nullptr;
  ThemeName theme = ThemeName::Light;
  double font_px = kFont_px;
  bool restyle = true;
};

UiHost::UiHost(GlContext& context) : state_(std::make_unique<State>(State{context})) {
  context.makeCurrent();
  loadFunctions();
  state_->ui = ImGui::CreateContext();
  ImGui::SetCurrentContext(state_->ui);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  if (!ImGui_ImplOpenGL3_Init("#version 150")) {
    ImGui::DestroyContext(state_->ui);
    throw std::runtime_error("OpenGL: the window's shaders could not be built");
  }
}

UiHost::~UiHost() {
  try {
    makeCurrent();
    ImGui_ImplOpenGL3_Shutdown();
  } catch (const std::exception&) {
    // The context is gone, and its objects with it.
  }
  ImGui::DestroyContext(state_->ui);
}

void UiHost::setLook(ThemeName theme, double scale) {
  const double font_px = kFont_px * scale;
  if (theme == state_->theme && font_px == state_->font_px) return;
  state_->theme = theme;
  state_->font_px = font_px;
  state_->restyle = true;
}

void UiHost::makeCurrent() {
  state_->gl.makeCurrent();
  ImGui::SetCurrentContext(state_->ui);
}

void UiHost::begin() {
  makeCurrent();
  if (state_->restyle) {
    state_->restyle = false;
    applyTheme(state_->theme, state_->font_px);
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    buildFont(*ImGui::GetIO().Fonts, state_->font_px);
  }
  ImGui_ImplOpenGL3_NewFrame();
  if (!ImGui::GetIO().Fonts->TexID) ImGui_ImplOpenGL3_CreateFontsTexture();
  ImGui::NewFrame();
}

void UiHost::end(unsigned framebuffer, int width, int height) {
  ImGui::Render();
  state_->gl.makeCurrent();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  const Rgb panel = themeOf(state_->theme).panel;
  glClearColor(static_cast<float>(panel.r), static_cast<float>(panel.g), static_cast<float>(panel.b), 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

UiSurface::UiSurface(GlContext& context, int width, int height)
    : context_(context), width_(width), height_(height) {
  context_.makeCurrent();
  loadFunctions();
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("OpenGL: no colour buffer of " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels could be made");
}

UiSurface::~UiSurface() {
  try {
    context_.makeCurrent();
  } catch (const std::exception&) {
    return;  // the context is gone, and its objects with it
  }
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
}

void UiSurface::finish() const {
  context_.makeCurrent();
  glFinish();
}

RgbImage UiSurface::read() const {
  context_.makeCurrent();
  RgbImage upside_down(width_, height_), image(width_, height_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, upside_down.pixels.data());
  const std::size_t row = static_cast<std::size_t>(width_) * 3;
  for (int y = 0; y < height_; ++y)
    std::memcpy(image.pixels.data() + row * y, upside_down.pixels.data() + row * (height_ - 1 - y), row);
  return image;
}

UiTexture::~UiTexture() {
  if (texture_) glDeleteTextures(1, &texture_);
}

void UiTexture::set(const RgbImage& image) {
  if (!texture_) glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
               image.pixels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  width_ = image.width;
  height_ = image.height;
}

}  // namespace vantage
