#include "dem_core/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kerf::dem {

namespace {

/// Spheres with these E* and G* among themselves.
void set_moduli(Material& m, double reduced_young, double reduced_shear) {
  const double q = reduced_shear / reduced_young; // (1 - nu) / (2 (2 - nu))
  m.poisson_ratio = (1.0 - 4.0 * q) / (1.0 - 2.0 * q);
  m.young_modulus = 2.0 * (1.0 - m.poisson_ratio * m.poisson_ratio) * reduced_young;
}

Material mixed(const Material& a, const Material& b) {
  if (a == b)
    return a;
  Material m;
  m.law = a.law;
  for (double Material::*const constant :
       {&Material::friction, &Material::rolling_friction, &Material::restitution,
        &Material::tensile_strength, &Material::shear_strength, &Material::tensile_stress,
        &Material::shear_stress, &Material::bond_radius_ratio})
    m.*constant = std::min(a.*constant, b.*constant);
  if (m.law == NormalLaw::hertz_mindlin) {
    double young = 0.0, shear = 0.0; // 1/E*, 1/G*, 1/Pa
    for (const Material& one : {a, b}) {
      young += (1.0 - one.poisson_ratio * one.poisson_ratio) / one.young_modulus;
      shear += 2.0 * (2.0 - one.poisson_ratio) * (1.0 + one.poisson_ratio) / one.young_modulus;
    }
    set_moduli(m, 1.0 / young, 1.0 / shear);
  }
  return m;
}

Mixture mixture_of(const Material& first, const Material& second, bool bonds) {
  return {first, second, mixed(first, second),
          bonds && first.has_springs() && second.has_springs()};
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
    must(m.bond_radius_ratio == 0.0 || m.has_springs(),
         "without springs there are no bonds: bond_radius_ratio must be 0", m.bond_radius_ratio);
  }
  if (m.contact_modulus > 0.0) {
    must(std::isfinite(m.contact_modulus), "contact_modulus must be finite", m.contact_modulus);
    not_negative("stiffness_ratio", m.stiffness_ratio);
  } else if (m.law == NormalLaw::linear || m.normal_stiffness != 0.0) {
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

Materials::Materials(Material one, std::span<const Material> others,
                     std::span<const MaterialPair> pairs)
    : all_({std::move(one)}) {
  all_.insert(all_.end(), others.begin(), others.end());
  const std::size_t n = all_.size();
  if (n > 256)
    throw std::invalid_argument(fmt::format("{} materials are more than 256", n));
  for (const Material& material : all_)
    check(material);
  std::vector<const MaterialPair*> given(n * n, nullptr);
  for (const MaterialPair& pair : pairs) {
    if (pair.first >= n || pair.second >= n)
      throw std::invalid_argument(
          fmt::format("there are no materials {} and {}", pair.first, pair.second));
    if (given[pair.first * n + pair.second] != nullptr)
      throw std::invalid_argument(
          fmt::format("materials {} and {} are given twice as a pair", pair.first, pair.second));
    check(pair.of_first);
    check(pair.of_second);
    given[pair.first * n + pair.second] = given[pair.second * n + pair.first] = &pair;
  }
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      const MaterialPair* pair = given[a * n + b];
      const bool is_turned = pair != nullptr && pair->first != a;
      mixtures_.push_back(pair == nullptr ? mixture_of(all_[a], all_[b], true)
                          : is_turned     ? mixture_of(pair->of_second, pair->of_first, pair->bonds)
                                      : mixture_of(pair->of_first, pair->of_second, pair->bonds));
      if (mixtures_.back().first.law != mixtures_.back().second.law)
        throw std::invalid_argument(fmt::format(
            "materials {} and {} have different laws, and no pair says which counts", a, b));
    }
}

bool Materials::may_bond() const {
  return std::any_of(mixtures_.begin(), mixtures_.end(), [](const Mixture& m) { return m.bonds; });
}

bool Materials::has_hertzian() const {
  return std::any_of(mixtures_.begin(), mixtures_.end(),
                     [](const Mixture& m) { return m.is_hertzian(); });
}

ContactLaw Materials::linear_law() const {
  const auto has_more = [](const Mixture& m) {
    return (m.bonds || !m.is_hertzian()) &&
           (m.both.restitution < 1.0 || m.both.rolling_friction > 0.0 ||
            m.both.bond_radius_ratio > 0.0);
  };
  return std::any_of(mixtures_.begin(), mixtures_.end(), has_more) ? ContactLaw::linear_with_moments
                                                                   : ContactLaw::linear;
}

void Materials::set_friction(double friction) {
  for (Material& material : all_) {
    material.friction = friction;
    check(material);
  }
  for (Mixture& mixture : mixtures_)
    mixture.first.friction = mixture.second.friction = mixture.both.friction = friction;
}

template <int dim>
void set_materials(Particles<dim>& particles, std::span<const std::uint8_t> material_of,
                   const Materials& materials) {
  if (materials.is_one() && material_of.empty())
    return;
  if (material_of.size() != particles.size())
    throw std::invalid_argument(
        fmt::format("{} particles but the materials of {}", particles.size(), material_of.size()));
  for (std::size_t i = 0; i < material_of.size(); ++i) {
    if (material_of[i] >= materials.all().size())
      throw std::invalid_argument(fmt::format("particle {} is of material {}, which is not there",
                                              particles.ids[i], material_of[i]));
    particles.density[i] = materials.all()[material_of[i]].density;
  }
  particles.material.assign(material_of.begin(), material_of.end());
  blend(particles, std::span<const double>());
}

template void set_materials<2>(Particles<2>&, std::span<const std::uint8_t>, const Materials&);
template void set_materials<3>(Particles<3>&, std::span<const std::uint8_t>, const Materials&);

} // namespace kerf::dem
