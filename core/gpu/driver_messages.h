#pragma once

#include <string>

namespace vantage {

/// Catches what libEGL and the drivers print on standard error while an instance lives. Their lines can't be
/// silenced reliably through variables, since some appear before those are read. Lines of others are passed
/// on by finish().
class DriverMessages {
 public:
  DriverMessages();
  ~DriverMessages();
  DriverMessages(const DriverMessages&) = delete;
  DriverMessages& operator=(const DriverMessages&) = delete;

  /// Restores standard error; returns the driver's lines.
  std::string finish();

 private:
  int saved_ = -1;
  int sink_ = -1;
};

/// True for a line that libEGL, Mesa or a kernel driver's user part writes.
bool isDriverMessage(const std::string& line);

}  // namespace vantage
