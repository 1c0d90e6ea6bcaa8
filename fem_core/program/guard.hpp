// Watches a body that deforms: no element may turn inside out, and the time step must stay below
// the critical one, which falls as elements are squeezed.
#pragma once

#include "fem_core/engine.hpp"

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace kerf::fem {

/// The body can be computed no further. The engine is in the last state that was good.
class LostBody : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

template <int dim> class Guard {
public:
  /// @param time_step    s
  /// @param is_unstable  the step may be above the critical one
  /// @param is_alone     nobody else acts on the body, so that steps can be made again
  Guard(Engine<dim>& engine, double time_step, bool is_unstable, bool is_alone);

  /// Once in a thousand steps: a look costs some steps. Bodies whose strains are small are as
  /// stable as they were at the start.
  bool is_due() const { return deforms_ && engine_.step() % 1000 == 0; }

  /// Looks at the state between two steps. When it is lost, the steps since the last look are made
  /// again, by halves, to find the first that is.
  /// @throws LostBody with the element, its region, and the time
  void look();

private:
  std::optional<std::string> fault() const;

  Engine<dim>& engine_;
  double time_step_;
  bool is_unstable_, is_alone_, deforms_;
  State good_; // of the last look
};

} // namespace kerf::fem
