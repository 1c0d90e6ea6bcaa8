#include "dem_core/contact_constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

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
};

template <int dim>
Constants constants_of(const Material& m, double density, double r_i, double r_j, bool bonded) {
  const auto mass = [&](double r) {
    return density * (dim == 2 ? pi * r * r : 4.0 / 3.0 * pi * r * r * r);
  };
  const double smaller = std::min(r_i, r_j);
  const double reduced_radius = r_i * r_j / (r_i + r_j);
  const double reduced_mass = mass(r_i) * mass(r_j) / (mass(r_i) + mass(r_j));
  const double bond_radius = (m.bond_radius_ratio > 0.0 ? m.bond_radius_ratio : 1.0) * smaller;

  Constants c;
  double viscosity = 2.0; // over sqrt(m* k)
  double of_now = 1.0;    // normal stiffness over k_n, but for powers of the overlap
  if (m.law == NormalLaw::hertz_mindlin) {
    c.k_n = 4.0 / 3.0 * std::sqrt(reduced_radius) * m.young_modulus /
            (2.0 * (1.0 - m.poisson_ratio * m.poisson_ratio));
    c.k_t = 8.0 * std::sqrt(reduced_radius) * m.young_modulus /
            (4.0 * (1.0 + m.poisson_ratio) * (2.0 - m.poisson_ratio));
    viscosity = 2.0 * std::sqrt(5.0 / 6.0);
    of_now = 1.5;
  } else if (m.contact_modulus > 0.0) {
    c.k_n = dim == 2 ? m.contact_modulus : 4.0 * m.contact_modulus * reduced_radius;
    c.k_t = m.stiffness_ratio * c.k_n;
  } else {
    c.k_n = m.normal_stiffness;
    c.k_t = m.tangential_stiffness;
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
  return c;
}

bool depends_on_sizes(const Material& m) {
  return law_of(m) != ContactLaw::linear || m.contact_modulus > 0.0 ||
         std::isfinite(m.tensile_stress) || std::isfinite(m.shear_stress);
}

} // namespace

void check(const Material& m) {
  const auto must = [](bool holds, const char* what, double value) {
    if (!holds)
      throw std::invalid_argument(fmt::format("{}, not {}", what, value));
  };
  const auto not_negative = [&](const char* what, double value) {
    must(value >= 0.0, fmt::format("{} must not be negative", what).c_str(), value);
  };
  if (m.law == NormalLaw::hertz_mindlin) {
    must(m.young_modulus > 0.0 && std::isfinite(m.young_modulus), "young_modulus must be positive",
         m.young_modulus);
    must(m.poisson_ratio > -1.0 && m.poisson_ratio <= 0.5, "poisson_ratio must lie in (-1, 0.5]",
         m.poisson_ratio);
    must(m.bond_radius_ratio == 0.0, "hertz_mindlin has no bonds: bond_radius_ratio must be 0",
         m.bond_radius_ratio);
  } else if (m.contact_modulus > 0.0) {
    must(std::isfinite(m.contact_modulus), "contact_modulus must be finite", m.contact_modulus);
    not_negative("stiffness_ratio", m.stiffness_ratio);
  } else {
    must(m.normal_stiffness > 0.0 && std::isfinite(m.normal_stiffness),
         "normal_stiffness must be positive", m.normal_stiffness);
    must(m.tangential_stiffness >= 0.0 && std::isfinite(m.tangential_stiffness),
         "tangential_stiffness must not be negative", m.tangential_stiffness);
  }
  not_negative("tensile_strength", m.tensile_strength);
  not_negative("shear_strength", m.shear_strength);
  not_negative("tensile_stress", m.tensile_stress);
  not_negative("shear_stress", m.shear_stress);
  not_negative("friction", m.friction);
  not_negative("rolling_friction", m.rolling_friction);
  not_negative("bond_radius_ratio", m.bond_radius_ratio);
  must(m.restitution > 0.0 && m.restitution <= 1.0, "restitution must lie in (0, 1]",
       m.restitution);
}

ContactLaw law_of(const Material& m) {
  if (m.law == NormalLaw::hertz_mindlin)
    return ContactLaw::hertz_mindlin;
  return m.restitution < 1.0 || m.rolling_friction > 0.0 || m.bond_radius_ratio > 0.0
             ? ContactLaw::linear_with_moments
             : ContactLaw::linear;
}

template <int dim>
void set_constants(Contacts<dim>& c, const Particles<dim>& particles, const Material& material) {
  c.law = law_of(material);
  c.friction.set_all(material.friction);
  const std::pair<PerContact*, double Constants::*> constants[] = {
      {&c.normal_stiffness, &Constants::k_n},  {&c.tangential_stiffness, &Constants::k_t},
      {&c.tensile_strength, &Constants::R_n},  {&c.shear_strength, &Constants::R_t},
      {&c.normal_viscosity, &Constants::c_n},  {&c.tangential_viscosity, &Constants::c_t},
      {&c.bending_stiffness, &Constants::k_b}, {&c.twisting_stiffness, &Constants::k_w},
      {&c.bond_lever, &Constants::lever},      {&c.rolling_limit, &Constants::rolling}};
  if (!depends_on_sizes(material)) {
    const Constants all = constants_of<dim>(material, particles.density, 1.0, 1.0, false);
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
    const Constants one =
        constants_of<dim>(material, particles.density, particles.radius[c.first[k]],
                          particles.radius[c.second[k]], c.was_bonded(k));
    for (std::size_t which = 0; which < each.size(); ++which)
      each[which][k] = one.*constants[which].second;
  }
  for (std::size_t which = 0; which < each.size(); ++which)
    constants[which].first->set_each(std::move(each[which]));
}

template <int dim>
PairConstants pair_constants(const Material& material, double density, double r_i, double r_j) {
  const Constants c = constants_of<dim>(material, density, r_i, r_j, false);
  return {law_of(material), c.k_n, c.k_t, c.k_b, c.c_n, c.c_t};
}

template PairConstants pair_constants<2>(const Material&, double, double, double);
template PairConstants pair_constants<3>(const Material&, double, double, double);
template void set_constants<2>(Contacts<2>&, const Particles<2>&, const Material&);
template void set_constants<3>(Contacts<3>&, const Particles<3>&, const Material&);

} // namespace kerf::dem
