// Simplices with a volumetric strain that is averaged over their nodes, so that they do not lock;
// J. Bonet and A. J. Burton, doi:10.1002/(SICI)1099-0887(199805)14:5<437::AID-CNM162>3.0.CO;2-W.
//
// A node has the mean dilatation of the elements around it, weighted with their volumes, and an
// element that of its nodes. Its pressure works on its own dilatation: summed over the elements
// that is the work of the nodes' mean pressures on the nodes' dilatations.
#pragma once

#include "fem_core/kernels/response.hpp"

namespace kerf::KERF_ISA {

/// Adds dilatation times volume, and volume, to the nodes: the first two numbers of their rows.
template <Shape shape, Kinematics kinematics, Space space>
void dilatation_kernel(PatchView& patch) {
  PatchView view = patch;
  for_vectors(
      view, [&](std::size_t first, int count) __attribute__((always_inline)) {
        using Elements = ElementVector<shape, kinematics, space>;
        Elements e(view, first, count);
        Deformation<Elements::dim> d;
        PointForce<Elements::dim> f;
        e.deform(0, d, f);
        Columns<Elements::dim> share{};
        share.c[0] = (-1.0 / Elements::nodes) * f.volume * d.own_trace;
        share.c[1] = (-1.0 / Elements::nodes) * f.volume;
        for (int a = 0; a < Elements::nodes; ++a)
          subtract(view.force, view.nodes + place(first, Elements::nodes) + a * batch_size, share,
                   count);
      });
}

template <Shape shape, Kinematics kinematics, Space space, class Response>
void nodal_pressure_kernel(PatchView& patch) {
  PatchView view = patch;
  WorkLanes work;
  for_vectors(
      view, [&](std::size_t first, int count) __attribute__((always_inline)) {
        using Elements = ElementVector<shape, kinematics, space>;
        Elements e(view, first, count);
        Deformation<Elements::dim> d;
        PointForce<Elements::dim> f;
        e.deform(0, d, f);
        const std::uint16_t* node = view.nodes + place(first, Elements::nodes);
        Lanes mean{};
        for (int a = 0; a < Elements::nodes; ++a)
          for (int l = 0; l < width; ++l)
            mean[l] += view.dilatation[node[a * batch_size + l] / fem::row_size<Elements::dim>] /
                       Elements::nodes;
        const Lanes missing = (1.0 / 3.0) * (mean - d.own_trace);
        for (int k = 0; k < 3; ++k)
          d.strain[k] += missing;
        e.add(0, f, Response::stress(e, 0, d, f, work));
        e.scatter();
      });
  book(work, patch);
}

} // namespace kerf::KERF_ISA
