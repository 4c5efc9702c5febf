#pragma once

#include <stdexcept>
#include <string>

namespace vantage {

/// Bad input or usage: a file, key or value that a person can put right. `where` names file, line or field;
/// the message says what is wrong and what to do. The executable prints `vantage: WHERE: MESSAGE` and exits
/// with 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& where, const std::string& message)
      : std::runtime_error(where + ": " + message) {}
};

}  // namespace vantage
