#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/gpu/gl_context.h"

namespace vantage {

/// One way to a context that was tried.
struct GlAttempt {
  std::string platform;  ///< "device 0 (software)", "surfaceless", "pbuffer"
  std::string reason;    ///< why it failed; empty for the one that worked
};

/// What is known about a machine on which no context could be made; the facts that advice rests on.
struct GlFailure {
  std::vector<GlAttempt> attempts;
  std::string driver_messages;      ///< what libEGL and the driver printed meanwhile
  bool vendor_library = false;      ///< libEGL found a vendor: it lists client extensions
  bool nvidia_device = false;       ///< an NVIDIA kernel driver is there
  bool nvidia_vendor_file = false;  ///< and its EGL vendor file
};

/// No usable OpenGL on this machine. what() is one line: what was tried and what helps. The executable exits
/// with 3.
class GlUnavailable : public std::runtime_error {
 public:
  explicit GlUnavailable(GlFailure failure);
  const GlFailure& failure() const { return failure_; }

 private:
  GlFailure failure_;
};

/// What a person can do about a failure: names the package, file or variable.
std::string adviseOnGl(const GlFailure& failure);

/// OpenGL core context of at least `major`.`minor` with no window and no display: every EGL device (hardware
/// first), then Mesa's surfaceless platform, then a pixel buffer on the default display. Nothing that the
/// driver prints meanwhile reaches standard error. Bound to the constructing thread until released; construct
/// on one thread at a time.
class EglContext final : public GlContext {
 public:
  /// \throws GlUnavailable with every attempt and advice.
  explicit EglContext(int major = 3, int minor = 2);
  ~EglContext() override;
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void makeCurrent() override;
  bool isCurrent() const override;
  std::string describe() const override;

  /// Unbinds it from this thread, so that another may make it current.
  void release();
  /// Address of an OpenGL function, null if the driver lacks it.
  void* function(const char* name) const;
  /// Attempts before this context, and the one that worked last.
  const std::vector<GlAttempt>& attempts() const;
  /// Harmless messages of the driver, for the log.
  const std::string& driverMessages() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
