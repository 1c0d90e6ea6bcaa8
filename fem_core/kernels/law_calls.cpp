// The laws as functions that kernels call. Compiled once for every set of instructions.
#include "fem_core/kernels/response.hpp"
#include "fem_core/laws/drucker_prager.hpp"
#include "fem_core/laws/isotropic_damage.hpp"
#include "fem_core/laws/j2_plastic.hpp"
#include "fem_core/laws/plane_stress.hpp"
#include "fem_core/laws/transversely_isotropic.hpp"

namespace kerf::KERF_ISA {
namespace {

using fem::LawKey;
using Call = void (*)();

template <class Law, int dim> void increment(const void* parameters, LawPoint<dim>& point) {
  const Law& law = *static_cast<const Law*>(parameters);
  Lanes history[Law::history + 1];
  for (int k = 0; k < Law::history; ++k)
    history[k] = load(point.history + k * batch_size);
  point.dissipated =
      law.template update<LaneMath, dim>(point.stress, history, point.strain, point.time_step);
  for (int k = 0; k < Law::history; ++k)
    store(point.history + k * batch_size, history[k]);
}

template <class Law, int dim> void whole(const void* parameters, LawPoint<dim>& point) {
  point.stress = static_cast<const Law*>(parameters)->template stress<LaneMath, dim>(point.strain);
}

template <class Law, int dim> Call call_of(bool increments) {
  if constexpr (fem::LinearLaw<Law>)
    if (!increments)
      return reinterpret_cast<Call>(&whole<Law, dim>);
  return reinterpret_cast<Call>(&increment<Law, dim>);
}

template <class Law> Call call_of(const LawKey& key) {
  if (key.dim == 3)
    return call_of<Law, 3>(key.increments);
  if (key.plane_stress)
    return call_of<fem::PlaneStress<Law>, 2>(key.increments);
  return call_of<Law, 2>(key.increments);
}

} // namespace

/// Null for a hyperelastic law, which is not called.
Call law_call(const LawKey& key) {
  switch (key.law) {
  case 0:
    return call_of<fem::IsotropicElastic>(key);
  case 1:
    return call_of<fem::TransverselyIsotropic>(key);
  case 3:
    return call_of<fem::J2Plastic>(key);
  case 4:
    return call_of<fem::DruckerPrager>(key);
  case 5:
    return call_of<fem::IsotropicDamage>(key);
  default:
    return nullptr;
  }
}

} // namespace kerf::KERF_ISA
