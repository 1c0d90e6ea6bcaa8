#include "dem_core/contact_forces.hpp"

#include "common/instruction_set.hpp"

#include <algorithm>

// The kernels of contact_kernel.cpp.
#define KERF_DECLARE(isa)                                                                          \
  namespace kerf::isa {                                                                            \
  template <int dim> dem::ContactKernel<dim> kernel_of(dem::ContactLaw law);                       \
  }
KERF_DECLARE(baseline)
KERF_DECLARE(avx2)
KERF_DECLARE(avx512)

namespace kerf::dem {

namespace {

template <int dim> ContactKernel<dim> kernel(ContactLaw law) {
  using Choose = ContactKernel<dim> (*)(ContactLaw);
  return dispatch<Choose>(baseline::kernel_of<dim>, avx2::kernel_of<dim>,
                          avx512::kernel_of<dim>)(law);
}

void append(void* list, std::uint32_t contact, BreakMode mode, double energy) {
  static_cast<std::vector<Break>*>(list)->push_back({contact, mode, energy});
}

ContactConstant constant(const PerContact& values) {
  return {values.is_uniform() ? nullptr : values.each().data(), values.all()};
}

/// The view of all contacts, of no block in particular.
template <int dim>
ContactView<dim> view_of(Contacts<dim>& c, const Particles<dim>& p, const Increment<dim>& increment,
                         ShearIncrement rule, Loads<dim>& loads) {
  ContactView<dim> view{};
  view.first = c.first.data();
  view.second = c.second.data();
  view.target = c.target.data();
  for (int a = 0; a < dim; ++a)
    view.reference_branch[a] = c.reference_branch.of[a].data();
  view.rest_length = c.rest_length.data();
  view.share = c.share.data();
  view.normal_stiffness = constant(c.normal_stiffness);
  view.tangential_stiffness = constant(c.tangential_stiffness);
  view.tensile_strength = constant(c.tensile_strength);
  view.shear_strength = constant(c.shear_strength);
  view.friction = constant(c.friction);
  view.weight = constant(c.weight);
  view.normal_viscosity = constant(c.normal_viscosity);
  view.tangential_viscosity = constant(c.tangential_viscosity);
  view.bending_stiffness = constant(c.bending_stiffness);
  view.twisting_stiffness = constant(c.twisting_stiffness);
  view.bond_lever = constant(c.bond_lever);
  view.rolling_limit = constant(c.rolling_limit);
  view.bonded = c.bonded.data();
  view.normal_force = c.normal_force.data();
  for (int a = 0; a < ContactView<dim>::shear_components; ++a)
    view.shear[a] = c.shear_force.of[a].data();
  for (int a = 0; a < ContactView<dim>::shear_components; ++a)
    view.moment[a] = c.moment.of[a].data();
  view.displacement = p.displacement.front().data();
  view.translation = increment.translation.front().data();
  view.rotation = increment.rotation.front().data();
  view.scale = increment.scale;
  view.rate = increment.time > 0.0 ? 1.0 / increment.time : 0.0;
  view.half = rule == ShearIncrement::midpoint ? 0.5 : 0.0;
  view.loads = reinterpret_cast<double*>(loads.own.data());
  view.on_break = append;
  return view;
}

} // namespace

template <int dim>
std::vector<Break> compute_contact_forces(Contacts<dim>& contacts, const Particles<dim>& particles,
                                          const Increment<dim>& increment, ShearIncrement rule,
                                          Loads<dim>& loads) {
  const std::size_t n = particles.size();
  loads.own.resize(n + contacts.waiting_rows());
  const auto all = view_of(contacts, particles, increment, rule, loads);
  const ContactKernel<dim> linear = kernel<dim>(contacts.law);
  const ContactKernel<dim> hertzian = kernel<dim>(ContactLaw::hertz_mindlin);
  const auto blocks = static_cast<std::int64_t>(contacts.blocks());
  std::vector<std::vector<Break>> breaks(contacts.blocks());
  const auto row = [&](std::size_t r) {
    return loads.own.begin() + static_cast<std::ptrdiff_t>(r);
  };

#pragma omp parallel if (blocks > 1)
  {
#pragma omp for schedule(static)
    for (std::int64_t b = 0; b < blocks; ++b) {
      const std::size_t first = static_cast<std::size_t>(b) * particles_per_block;
      std::fill(row(first), row(std::min(n, first + particles_per_block)), Load<dim>());
      std::fill(row(contacts.waiting_offset[b]), row(contacts.waiting_offset[b + 1]), Load<dim>());
      const auto compute = [&](ContactKernel<dim> compute_part, std::size_t begin,
                               std::size_t loose, std::size_t end) {
        if (begin == end)
          return;
        ContactView<dim> view = all;
        view.begin = begin;
        view.loose = loose;
        view.end = end;
        view.breaks = &breaks[b];
        compute_part(view);
        contacts.losses[b].friction += view.friction_loss;
        contacts.losses[b].fracture += view.fracture_loss;
        contacts.losses[b].viscous += view.viscous_loss;
      };
      const std::size_t hertz = contacts.hertz_offset[b];
      compute(linear, contacts.block_offset[b], contacts.loose_offset[b], hertz);
      compute(hertzian, hertz, hertz, contacts.block_offset[b + 1]);
    }
#pragma omp for schedule(static)
    for (std::int64_t b = 0; b < blocks; ++b)
      for (std::uint32_t e = contacts.incoming_offset[b]; e < contacts.incoming_offset[b + 1];
           ++e) {
        const std::size_t ahead = std::min<std::size_t>(e + 16, contacts.waiting_rows() - 1);
        __builtin_prefetch(&loads.own[contacts.incoming_row[ahead]]);
        __builtin_prefetch(&loads.own[contacts.incoming_second[ahead]]);
        Load<dim>& load = loads.own[contacts.incoming_second[e]];
        const Load<dim>& waiting = loads.own[contacts.incoming_row[e]];
        load.force += waiting.force;
        load.moment += waiting.moment;
      }
  }
  std::vector<Break> list;
  for (const std::vector<Break>& part : breaks)
    list.insert(list.end(), part.begin(), part.end());
  return list;
}

template std::vector<Break> compute_contact_forces<2>(Contacts<2>&, const Particles<2>&,
                                                      const Increment<2>&, ShearIncrement,
                                                      Loads<2>&);
template std::vector<Break> compute_contact_forces<3>(Contacts<3>&, const Particles<3>&,
                                                      const Increment<3>&, ShearIncrement,
                                                      Loads<3>&);

} // namespace kerf::dem
