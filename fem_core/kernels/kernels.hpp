// The kernels of one shape.
#pragma once

#include "fem_core/kernels/nodal_pressure.hpp"
#include "fem_core/kernels/one_point.hpp"

namespace kerf::KERF_ISA {

/// Full integration.
template <Shape shape, Kinematics kinematics, Space space, class Response>
void full_kernel(PatchView& patch) {
  PatchView view = patch; // a copy: nothing else can change its constants
  WorkLanes work;
  for_vectors(
      view, [&](std::size_t first, int count) __attribute__((always_inline)) {
        ElementVector<shape, kinematics, space> e(view, first, count);
#pragma GCC unroll 8
        for (int q = 0; q < e.points; ++q) {
          Deformation<e.dim> d;
          PointForce<e.dim> f;
          e.deform(q, d, f);
          e.add(q, f, Response::stress(e, q, d, f, work));
        }
        e.scatter();
      });
  book(work, patch);
}

/// B-bar: the volumetric strain is its mean over the element, and so is the pressure that answers.
template <Shape shape, Kinematics kinematics, Space space, class Response>
void mean_dilatation_kernel(PatchView& patch) {
  PatchView view = patch;
  WorkLanes work;
  for_vectors(
      view, [&](std::size_t first, int count) __attribute__((always_inline)) {
        using Elements = ElementVector<shape, kinematics, space>;
        constexpr int dim = Elements::dim, points = Elements::points;
        Elements e(view, first, count);
        Deformation<dim> d[points];
        PointForce<dim> f[points];
        Lanes volume{}, dilatation{};
        for (int q = 0; q < points; ++q) {
          e.deform(q, d[q], f[q]);
          volume += f[q].middle;
          dilatation += f[q].middle * trace(d[q].strain);
        }
        dilatation /= volume;
        Lanes end{}, pressure{};
        Tensor<dim> stress[points];
        for (int q = 0; q < points; ++q) {
          const Lanes missing = (1.0 / 3.0) * (dilatation - trace(d[q].strain));
          for (int k = 0; k < 3; ++k)
            d[q].strain[k] += missing;
          d[q].own_trace = dilatation; // the mean pressure below works on the mean
          stress[q] = Response::stress(e, q, d[q], f[q], work);
          end += f[q].end;
          pressure += f[q].volume * trace(stress[q]);
        }
        pressure /= end; // of Cauchy's stress
        for (int q = 0; q < points; ++q) {
          Lanes wanted = pressure;
          if constexpr (kinematics == Kinematics::rate)
            wanted *= f[q].end / f[q].volume;
          const Lanes missing = (1.0 / 3.0) * (wanted - trace(stress[q]));
          for (int k = 0; k < 3; ++k)
            stress[q][k] += missing;
          e.add(q, f[q], stress[q]);
        }
        e.scatter();
      });
  book(work, patch);
}

} // namespace kerf::KERF_ISA
