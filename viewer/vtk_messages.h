#pragma once

#include <string>

namespace vantage {

/// Keeps VTK's messages out of standard error for the rest of the process; idempotent, any thread.
void silenceVtk();

/// VTK's warnings and errors since the last call, one a line; for logs and failure messages.
std::string takeVtkMessages();

}  // namespace vantage
