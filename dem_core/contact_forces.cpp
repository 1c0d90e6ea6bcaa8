#include "dem_core/contact_forces.hpp"

#include "common/instruction_set.hpp"

#include <omp.h>

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

template <int dim> void append(void* list, std::uint32_t contact, BreakMode mode, double energy) {
  static_cast<std::vector<Break<dim>>*>(list)->push_back({contact, mode, energy});
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
  view.travelled = increment.travelled;
  view.on_break = append<dim>;
  return view;
}

/// One pass over the blocks.
template <int dim> struct Pass {
  Contacts<dim>& contacts;
  const Particles<dim>& particles;
  Loads<dim>& loads;
  ContactView<dim> view; // of all blocks
  ContactKernel<dim> linear, hertzian;
  std::vector<std::vector<Break<dim>>> breaks;

  typename std::vector<Load<dim>>::iterator row(std::size_t r) const {
    return loads.own.begin() + static_cast<std::ptrdiff_t>(r);
  }

  /// What the contacts of a block do to its particles and to those of later ones.
  void compute(std::size_t b) {
    const auto [begin, end] = particle_block(b, particles.size());
    std::fill(row(begin), row(end), Load<dim>());
    std::fill(row(contacts.waiting_offset[b]), row(contacts.waiting_offset[b + 1]), Load<dim>());
    const std::size_t hertz = contacts.hertz_offset[b];
    compute(linear, contacts.block_offset[b], contacts.loose_offset[b], hertz, b);
    compute(hertzian, hertz, hertz, contacts.block_offset[b + 1], b);
    for (Break<dim>& lost : breaks[b]) {
      const Span<dim> span = span_of(contacts, particles, lost.contact);
      lost.place = particles.position(contacts.first[lost.contact]) +
                   contacts.share[lost.contact] * span.branch;
      lost.normal = span.normal();
    }
  }

  /// Contacts begin to end, all of one law, of which those before `loose` have or had a bond.
  void compute(ContactKernel<dim> law, std::size_t begin, std::size_t loose, std::size_t end,
               std::size_t b) {
    if (begin == end)
      return;
    ContactView<dim> part = view;
    part.begin = begin;
    part.loose = loose;
    part.end = end;
    // Chunks begin anew in each part: two more of them in a block than in the whole list.
    part.clear_until = &contacts.clear_until[loose / chunk_size + 2 * b + (law == hertzian)];
    part.breaks = &breaks[b];
    law(part);
    contacts.losses[b].friction += part.friction_loss;
    contacts.losses[b].fracture += part.fracture_loss;
    contacts.losses[b].viscous += part.viscous_loss;
  }

  /// All that a block receives comes from blocks that are not before this one.
  bool receives_from(std::size_t first, std::size_t b) const {
    const std::uint32_t incoming = contacts.incoming_offset[b];
    return incoming == contacts.incoming_offset[b + 1] ||
           contacts.incoming_row[incoming] >= contacts.waiting_offset[first];
  }
  /// What earlier blocks have left for this one.
  void receive(std::size_t b) {
    for (std::uint32_t e = contacts.incoming_offset[b]; e < contacts.incoming_offset[b + 1]; ++e) {
      const std::size_t ahead = std::min<std::size_t>(e + 16, contacts.waiting_rows() - 1);
      __builtin_prefetch(&loads.own[contacts.incoming_row[ahead]]);
      __builtin_prefetch(&loads.own[contacts.incoming_second[ahead]]);
      Load<dim>& load = loads.own[contacts.incoming_second[e]];
      const Load<dim>& waiting = loads.own[contacts.incoming_row[e]];
      load.force += waiting.force;
      load.moment += waiting.moment;
    }
  }
};

} // namespace

template <int dim>
std::vector<Break<dim>> compute_contact_forces(Contacts<dim>& contacts,
                                               const Particles<dim>& particles,
                                               const Increment<dim>& increment, ShearIncrement rule,
                                               Loads<dim>& loads, const BlockWork& complete) {
  loads.own.resize(particles.size() + contacts.waiting_rows());
  contacts.clear_until.resize(contacts.size() / chunk_size + 2 * contacts.blocks() + 1);
  const std::size_t blocks = contacts.blocks();
  Pass<dim> pass{contacts,
                 particles,
                 loads,
                 view_of(contacts, particles, increment, rule, loads),
                 kernel<dim>(contacts.law),
                 kernel<dim>(ContactLaw::hertz_mindlin),
                 std::vector<std::vector<Break<dim>>>(blocks)};
  const auto finish = [&](std::size_t b) {
    pass.receive(b);
    if (complete)
      complete(b);
  };
  // A block receives from earlier ones only, and only these look at its particles: it is complete
  // after its own contacts, but for what another thread still has to give.
#pragma omp parallel if (blocks > 1)
  {
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    const auto threads = static_cast<std::size_t>(omp_get_num_threads());
    const std::size_t first = blocks * thread / threads, last = blocks * (thread + 1) / threads;
    for (std::size_t b = first; b < last; ++b) {
      pass.compute(b);
      if (pass.receives_from(first, b))
        finish(b);
    }
#pragma omp barrier
    for (std::size_t b = first; b < last; ++b)
      if (!pass.receives_from(first, b))
        finish(b);
  }
  std::vector<Break<dim>> list;
  for (const std::vector<Break<dim>>& part : pass.breaks)
    list.insert(list.end(), part.begin(), part.end());
  return list;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template std::vector<Break<dim>> compute_contact_forces<dim>(                                    \
      Contacts<dim>&, const Particles<dim>&, const Increment<dim>&, ShearIncrement, Loads<dim>&,   \
      const BlockWork&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
