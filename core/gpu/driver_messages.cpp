#include "core/gpu/driver_messages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <sstream>

namespace vantage {

bool isDriverMessage(const std::string& line) {
  static constexpr std::array kMarks = {
      "libEGL", "libGL", "MESA",   "Mesa",   "DRI", "swrast", "GLIBCXX", "pci id", "failed to load driver",
      "kms",    "ZINK",  "nvidia", "NVIDIA", "EGL "};
  for (const char* mark : kMarks) {
    if (line.find(mark) != std::string::npos) return true;
  }
  return false;
}

DriverMessages::DriverMessages() {
  sink_ = memfd_create("vantage-driver-messages", MFD_CLOEXEC);
  if (sink_ < 0) return;
  std::fflush(stderr);
  saved_ = dup(STDERR_FILENO);
  // Without standard error there is nothing to keep clean.
  if (saved_ >= 0) dup2(sink_, STDERR_FILENO);
}

DriverMessages::~DriverMessages() {
  finish();
}

std::string DriverMessages::finish() {
  std::string caught;
  if (saved_ >= 0) {
    std::fflush(stderr);
    dup2(saved_, STDERR_FILENO);
    close(saved_);
    saved_ = -1;
    lseek(sink_, 0, SEEK_SET);
    std::array<char, 4096> block;
    for (ssize_t n = 0; (n = read(sink_, block.data(), block.size())) > 0;) caught.append(block.data(), n);
  }
  if (sink_ >= 0) close(sink_);
  sink_ = -1;

  std::string of_driver;
  std::istringstream lines(caught);
  for (std::string line; std::getline(lines, line);) {
    if (isDriverMessage(line)) {
      if (of_driver.find(line) != std::string::npos) continue;  // each attempt repeats it
      of_driver += (of_driver.empty() ? "" : "\n") + line;
    } else if (!line.empty()) {
      std::fprintf(stderr, "%s\n", line.c_str());
    }
  }
  return of_driver;
}

}  // namespace vantage
