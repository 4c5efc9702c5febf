#include "viewer/vtk_messages.h"

#include <vtkAutoInit.h>
#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <mutex>

// VTK's factories register here, in a file that everything which renders needs, so that no executable has to
// ask for it.
VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)
VTK_MODULE_INIT(vtkInteractionStyle)

namespace vantage {
namespace {

constexpr std::size_t kMostKept = 16384;

/// Where VTK's messages go instead of standard error.
class MessageSink : public vtkOutputWindow {
 public:
  static MessageSink* New();
  vtkTypeMacro(MessageSink, vtkOutputWindow);
  void DisplayText(const char* text) override {
    const std::lock_guard lock(mutex_);
    if (text && messages_.size() < kMostKept) messages_.append(text).append("\n");
  }
  void DisplayErrorText(const char* text) override { DisplayText(text); }
  void DisplayWarningText(const char* text) override { DisplayText(text); }
  void DisplayGenericWarningText(const char* text) override { DisplayText(text); }
  void DisplayDebugText(const char*) override {}
  std::string take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

 private:
  std::mutex mutex_;
  std::string messages_;
};
vtkStandardNewMacro(MessageSink);

}  // namespace

void silenceVtk() {
  static std::once_flag once;
  std::call_once(once, [] {
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    vtkOutputWindow::SetInstance(vtkSmartPointer<MessageSink>::New());
  });
}

std::string takeVtkMessages() {
  auto* sink = MessageSink::SafeDownCast(vtkOutputWindow::GetInstance());
  return sink ? sink->take() : std::string();
}

}  // namespace vantage
