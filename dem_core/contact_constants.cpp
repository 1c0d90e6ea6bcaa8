#include "dem_core/contact_constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace kerf::dem {

namespace {

using std::numbers::pi;

/// Share of critical damping that gives a coefficient of restitution.
double damping_ratio(double restitution) {
  const double log = std::log(restitution);
  return -log / std::sqrt(pi * pi + log * log);
}

struct Constants {
  double k_n = 0.0, k_t = 0.0; // N/m; Hertz-Mindlin: N/m^(3/2)
  double R_n = 0.0, R_t = 0.0; // N
  double c_n = 0.0, c_t = 0.0; // N s/m; Hertz-Mindlin: N s/m^(5/4)
  double k_b = 0.0, k_w = 0.0; // N m; Hertz-Mindlin: N m^(1/2)
  double lever = 0.0;          // A r / I of the bond, 1/m
  double rolling = 0.0;        // mu_r R*, m
  double mu = 0.0;
};

double in_series(double k_1, double k_2) {
  return k_1 > 0.0 && k_2 > 0.0 ? k_1 * k_2 / (k_1 + k_2) : 0.0;
}

/// Among particles of one material.
template <int dim> ContactStiffness springs_of(const Material& m, double r_i, double r_j) {
  if (!(m.contact_modulus > 0.0))
    return {m.normal_stiffness, m.tangential_stiffness};
  const double reduced_radius = r_i * r_j / (r_i + r_j);
  const double k_n = dim == 2 ? m.contact_modulus : 4.0 * m.contact_modulus * reduced_radius;
  return {k_n, m.stiffness_ratio * k_n};
}

template <int dim>
Constants constants_of(const Mixture& mixture, const std::array<double, 2>& density, double r_i,
                       double r_j, bool bonded) {
  const Material& m = mixture.both;
  const auto mass = [&](double rho, double r) {
    return rho * (dim == 2 ? pi * r * r : 4.0 / 3.0 * pi * r * r * r);
  };
  const double smaller = std::min(r_i, r_j);
  const double reduced_radius = r_i * r_j / (r_i + r_j);
  const double m_i = mass(density[0], r_i), m_j = mass(density[1], r_j);
  const double reduced_mass = m_i * m_j / (m_i + m_j);
  const double bond_radius = (m.bond_radius_ratio > 0.0 ? m.bond_radius_ratio : 1.0) * smaller;

  Constants c;
  double viscosity = 2.0; // over sqrt(m* k)
  double of_now = 1.0;    // normal stiffness over k_n, but for powers of the overlap
  if (mixture.is_hertzian() && !bonded) {
    c.k_n = 4.0 / 3.0 * std::sqrt(reduced_radius) * m.young_modulus /
            (2.0 * (1.0 - m.poisson_ratio * m.poisson_ratio));
    c.k_t = 8.0 * std::sqrt(reduced_radius) * m.young_modulus /
            (4.0 * (1.0 + m.poisson_ratio) * (2.0 - m.poisson_ratio));
    viscosity = 2.0 * std::sqrt(5.0 / 6.0);
    of_now = 1.5;
  } else {
    const ContactStiffness springs = bond_springs<dim>(mixture, r_i, r_j);
    c.k_n = springs.normal;
    c.k_t = springs.tangential;
  }
  const double area = dim == 2 ? 2.0 * bond_radius : pi * bond_radius * bond_radius;
  c.R_n = std::min(m.tensile_strength, area * m.tensile_stress);
  c.R_t = std::min(m.shear_strength, area * m.shear_stress);
  const double beta = damping_ratio(m.restitution);
  c.c_n = viscosity * beta * std::sqrt(reduced_mass * of_now * c.k_n);
  c.c_t = viscosity * beta * std::sqrt(reduced_mass * c.k_t);
  if (bonded && m.bond_radius_ratio > 0.0) {
    c.k_b = c.k_n * bond_radius * bond_radius / (dim == 2 ? 3.0 : 4.0);
    c.k_w = c.k_t * bond_radius * bond_radius / 2.0;
    c.lever = (dim == 2 ? 3.0 : 4.0) / bond_radius;
  } else if (m.rolling_friction > 0.0) {
    c.k_b = c.k_t * reduced_radius * reduced_radius;
  }
  c.rolling = m.rolling_friction * reduced_radius;
  c.mu = m.friction;
  return c;
}

bool depends_on_sizes(const Mixture& m, ContactLaw linear_law) {
  return m.is_hertzian() || linear_law != ContactLaw::linear || m.both.contact_modulus > 0.0 ||
         std::isfinite(m.both.tensile_stress) || std::isfinite(m.both.shear_stress);
}

} // namespace

template <int dim> ContactStiffness bond_springs(const Mixture& m, double r_i, double r_j) {
  if (m.is_of_one_kind())
    return springs_of<dim>(m.first, r_i, r_j);
  const ContactStiffness first = springs_of<dim>(m.first, r_i, r_i);
  const ContactStiffness second = springs_of<dim>(m.second, r_j, r_j);
  return {in_series(2.0 * first.normal, 2.0 * second.normal),
          in_series(2.0 * first.tangential, 2.0 * second.tangential)};
}

template <int dim>
void set_constants(Contacts<dim>& c, const Particles<dim>& particles, const Materials& materials) {
  const std::pair<PerContact*, double Constants::*> constants[] = {
      {&c.normal_stiffness, &Constants::k_n},
      {&c.tangential_stiffness, &Constants::k_t},
      {&c.tensile_strength, &Constants::R_n},
      {&c.shear_strength, &Constants::R_t},
      {&c.normal_viscosity, &Constants::c_n},
      {&c.tangential_viscosity, &Constants::c_t},
      {&c.bending_stiffness, &Constants::k_b},
      {&c.twisting_stiffness, &Constants::k_w},
      {&c.bond_lever, &Constants::lever},
      {&c.rolling_limit, &Constants::rolling},
      {&c.friction, &Constants::mu}};
  if (materials.is_one() && !depends_on_sizes(materials.mixtures()[0], c.law)) {
    const Constants all = constants_of<dim>(materials.mixtures()[0], {1.0, 1.0}, 1.0, 1.0, false);
    for (const auto& [target, member] : constants)
      target->set_all(all.*member);
    return;
  }
  std::array<std::vector<double>, std::size(constants)> each;
  for (std::vector<double>& values : each)
    values.resize(c.size());
  const auto count = static_cast<std::int64_t>(c.size());
#pragma omp parallel for schedule(static)
  for (std::int64_t k = 0; k < count; ++k) {
    const std::uint32_t i = c.first[k], j = c.second[k];
    const Constants one = constants_of<dim>(
        materials.between(particles, i, j), {particles.density[i], particles.density[j]},
        particles.radius[i], particles.radius[j], c.was_bonded(k));
    for (std::size_t which = 0; which < each.size(); ++which)
      each[which][k] = one.*constants[which].second;
  }
  for (std::size_t which = 0; which < each.size(); ++which) {
    std::vector<double>& values = each[which]; // kernels are faster with one number for all
    if (!values.empty() && std::equal(values.begin() + 1, values.end(), values.begin()))
      constants[which].first->set_all(values.front());
    else
      constants[which].first->set_each(std::move(values));
  }
}

template <int dim>
PairConstants pair_constants(const Mixture& m, const std::array<double, 2>& density, double r_i,
                             double r_j) {
  const Constants c = constants_of<dim>(m, density, r_i, r_j, false);
  return {m.is_hertzian(), c.k_n, c.k_t, c.k_b, c.c_n, c.c_t};
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template ContactStiffness bond_springs<dim>(const Mixture&, double, double);                     \
  template PairConstants pair_constants<dim>(const Mixture&, const std::array<double, 2>&, double, \
                                             double);                                              \
  template void set_constants<dim>(Contacts<dim>&, const Particles<dim>&, const Materials&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
