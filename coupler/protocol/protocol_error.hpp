// What is thrown at a message or a frame from outside that cannot be believed.
#pragma once

#include <stdexcept>

namespace kerf::coupler {

/// A message or frame from outside that does not follow the protocol; it says what is wrong.
class ProtocolError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace kerf::coupler
