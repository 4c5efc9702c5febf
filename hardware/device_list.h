#pragma once

#include <string>
#include <vector>

namespace vantage {

/// One device as `vantage devices` prints it.
struct DeviceEntry {
  std::string name;         ///< what --camera or --controller takes, e.g. "openni2:freenect://0"
  std::string role;         ///< "camera" or "arm"
  std::string description;  ///< maker and model, or the message type
};

/// What one kind of device answers.
struct DeviceKind {
  std::string kind;   ///< "openni2" or "ros"
  bool built = true;  ///< false: this program was built without it
  std::string
      note;  ///< why nothing is listed: which package to build with, or what does not answer; else empty
  std::vector<DeviceEntry> devices;
};

}  // namespace vantage
