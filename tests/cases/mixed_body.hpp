// A body of several materials that tests share: bonded rock under loose grains of glass.
#pragma once

#include "tests/cases/dem_models.hpp"

namespace kerf::cases {

inline dem::Material glass() {
  dem::Material material;
  material.density = 1500.0;
  material.law = dem::NormalLaw::hertz_mindlin;
  material.young_modulus = 2e9;
  material.poisson_ratio = 0.25;
  material.friction = 0.3;
  return material;
}

/// Rock, brittle by request, in the lower half of a cubic lattice, grains of Hertz and Mindlin in
/// the upper one, and contacts of Hertz and Mindlin between them. Grains and rock run into one
/// another.
inline dem::Settings<3> rock_and_grains(std::array<int, 3> count, double strength, double speed) {
  dem::Material rock = cases::rock(3);
  rock.tensile_strength = rock.shear_strength = strength;
  rock.friction = 0.5;
  rock.young_modulus = 1e10;
  rock.poisson_ratio = 0.2;
  auto settings = lattice_model<3>(dem::LatticeType::cubic, count, rock);
  settings.other_materials = {glass()};
  const double middle = (0.5 * count[2] - 0.5) * spacing;
  for (const Vec<3>& x : settings.positions)
    settings.material_of.push_back(x[2] > middle);
  dem::MaterialPair pair{0, 1, rock, glass()};
  pair.of_first.law = dem::NormalLaw::hertz_mindlin;
  settings.pairs = {pair};
  shake(settings, 0.2 * speed, 5);
  dem::InitialCondition<3> falling;
  falling.box = Box<3>{{-1.0, -1.0, middle}, {1.0, 1.0, 1.0}};
  falling.velocity = {0.0, 0.0, -speed};
  settings.initial.push_back(falling);
  return settings;
}

} // namespace kerf::cases
