// See fem_laws_kernel.hpp and cmake/instruction_sets.cmake.
#include "tests/unit/fem_laws_kernel.hpp"

#include "fem_core/laws/drucker_prager.hpp"
#include "fem_core/laws/isotropic_damage.hpp"
#include "fem_core/laws/j2_plastic.hpp"
#include "fem_core/laws/lane_math.hpp"
#include "fem_core/laws/plane_stress.hpp"
#include "fem_core/laws/transversely_isotropic.hpp"

namespace kerf::KERF_ISA {

using namespace kerf::fem;

template <class Law, int dim> void run_points(const Law& law, const PointColumns& points) {
  using Tensor = Symmetric<Lanes, dim>;
  constexpr int most_history = 8;
  for (int k = 0; k < points.count; k += width) {
    const auto read = [&](const double* column, int c) __attribute__((always_inline)) {
      return load(column + c * points.count + k);
    };
    Tensor stress;
    if constexpr (requires(Gradient<Lanes, dim> H) { law.template kirchhoff<LaneMath, dim>(H); }) {
      Gradient<Lanes, dim> H;
      if constexpr (dim == 2)
        H = {read(points.input, 0), read(points.input, 1), read(points.input, 2),
             read(points.input, 3), read(points.input, 4)};
      else
        H = {read(points.input, 0), read(points.input, 1), read(points.input, 2),
             read(points.input, 3), read(points.input, 4), read(points.input, 5),
             read(points.input, 6), read(points.input, 7), read(points.input, 8)};
      stress = law.template kirchhoff<LaneMath, dim>(H);
      store(points.dissipated + k, law.template energy_density<LaneMath, dim>(H));
    } else {
      Tensor increment;
      for (int c = 0; c < Tensor::size; ++c) {
        stress[c] = read(points.stress, c);
        increment[c] = read(points.input, c);
      }
      Lanes history[most_history];
      for (int h = 0; h < Law::history; ++h)
        history[h] = read(points.history, h);
      store(points.dissipated + k,
            law.template update<LaneMath, dim>(stress, history, increment, points.time_step));
      for (int h = 0; h < Law::history; ++h)
        store(points.history + h * points.count + k, history[h]);
    }
    for (int c = 0; c < Tensor::size; ++c)
      store(points.stress + c * points.count + k, stress[c]);
  }
}

template void run_points<IsotropicElastic, 2>(const IsotropicElastic&, const PointColumns&);
template void run_points<IsotropicElastic, 3>(const IsotropicElastic&, const PointColumns&);
template void run_points<TransverselyIsotropic, 2>(const TransverselyIsotropic&,
                                                   const PointColumns&);
template void run_points<TransverselyIsotropic, 3>(const TransverselyIsotropic&,
                                                   const PointColumns&);
template void run_points<NeoHookean, 2>(const NeoHookean&, const PointColumns&);
template void run_points<NeoHookean, 3>(const NeoHookean&, const PointColumns&);
template void run_points<J2Plastic, 2>(const J2Plastic&, const PointColumns&);
template void run_points<J2Plastic, 3>(const J2Plastic&, const PointColumns&);
template void run_points<DruckerPrager, 2>(const DruckerPrager&, const PointColumns&);
template void run_points<DruckerPrager, 3>(const DruckerPrager&, const PointColumns&);
template void run_points<IsotropicDamage, 2>(const IsotropicDamage&, const PointColumns&);
template void run_points<IsotropicDamage, 3>(const IsotropicDamage&, const PointColumns&);
template void run_points<PlaneStress<IsotropicElastic>, 2>(const PlaneStress<IsotropicElastic>&,
                                                           const PointColumns&);
template void run_points<PlaneStress<NeoHookean>, 2>(const PlaneStress<NeoHookean>&,
                                                     const PointColumns&);
template void run_points<PlaneStress<J2Plastic>, 2>(const PlaneStress<J2Plastic>&,
                                                    const PointColumns&);
template void run_points<PlaneStress<DruckerPrager>, 2>(const PlaneStress<DruckerPrager>&,
                                                        const PointColumns&);
template void run_points<PlaneStress<IsotropicDamage>, 2>(const PlaneStress<IsotropicDamage>&,
                                                          const PointColumns&);

void apply(LaneFunction function, const double* x, double* y, int count) {
  for (int k = 0; k < count; k += width) {
    const Lanes at = load(x + k);
    store(y + k, function == LaneFunction::logarithm     ? LaneMath::logarithm(at)
                 : function == LaneFunction::exponential ? LaneMath::exponential(at)
                                                         : LaneMath::logarithm_of_one_plus(at));
  }
}

} // namespace kerf::KERF_ISA
