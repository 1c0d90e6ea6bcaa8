#include "fem_core/material.hpp"

#include "common/instruction_set.hpp"
#include "fem_core/input_error.hpp"
#include "fem_core/laws/plane_stress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <type_traits>

namespace kerf {

namespace baseline {
void (*law_call(const fem::LawKey&))();
}
namespace avx2 {
void (*law_call(const fem::LawKey&))();
}
namespace avx512 {
void (*law_call(const fem::LawKey&))();
}

namespace fem {
namespace {

Kinematics kinematics_of(const Material& material) {
  if (std::holds_alternative<NeoHookean>(material.law))
    return Kinematics::total;
  return material.finite_strain ? Kinematics::rate : Kinematics::small;
}

int num_points(Shape shape, Formulation formulation) {
  if (formulation == Formulation::one_point || shape == Shape::tri3 || shape == Shape::tet4)
    return 1;
  return shape == Shape::quad4 ? 4 : 8;
}

/// A law as the kernels use it: in plane stress as one of its own.
template <class Use> auto with_law(const Material& material, Plane plane, Use use) {
  return std::visit(
      [&](const auto& law) {
        using LawType = std::decay_t<decltype(law)>;
        if (plane == Plane::stress)
          return use(PlaneStress<LawType>(law));
        return use(law);
      },
      material.law);
}

std::string name_of(Formulation formulation) {
  return std::array{"full", "mean_dilatation", "one_point",
                    "nodal_pressure"}[static_cast<std::size_t>(formulation)];
}

} // namespace

double Material::density() const {
  return std::visit([](const auto& any) { return any.density; }, law);
}

Moduli Material::bound() const {
  return std::visit([](const auto& any) { return any.bound(); }, law);
}

double Material::step_factor() const {
  return std::sqrt(1.0 + linear_viscosity * linear_viscosity) - linear_viscosity;
}

void check(const Material& material, Shape shape, Plane plane) {
  const bool simplex = shape == Shape::tri3 || shape == Shape::tet4;
  const Formulation formulation = material.formulation;
  const std::string name = name_of(formulation);
  if (simplex &&
      (formulation == Formulation::mean_dilatation || formulation == Formulation::one_point))
    throw InputError("formulation",
                     fmt::format("{} is of quad4 and hex8; {} has full or nodal_pressure", name,
                                 fem::name_of(shape)));
  if (!simplex && formulation == Formulation::nodal_pressure)
    throw InputError("formulation", fmt::format("{} is of tri3 and tet4; {} has full, "
                                                "mean_dilatation or one_point",
                                                name, fem::name_of(shape)));
  if (formulation == Formulation::one_point && plane == Plane::axisymmetric)
    throw InputError("formulation", "one_point is not there for axisymmetry; take full or "
                                    "mean_dilatation");
  if (plane == Plane::stress && formulation != Formulation::full &&
      formulation != Formulation::one_point)
    throw InputError("formulation", fmt::format("{} has no meaning in plane stress, where nothing "
                                                "locks; take full or one_point",
                                                name));
  if (!(material.linear_viscosity >= 0.0))
    throw InputError("linear_viscosity",
                     fmt::format("{} must not be negative", material.linear_viscosity));
  if (!(material.quadratic_viscosity >= 0.0))
    throw InputError("quadratic_viscosity",
                     fmt::format("{} must not be negative", material.quadratic_viscosity));
  if (!(material.hourglass_viscosity >= 0.0 && material.hourglass_viscosity <= 1.0))
    throw InputError("hourglass_viscosity",
                     fmt::format("{} must be from 0 to 1", material.hourglass_viscosity));
  if (std::holds_alternative<NeoHookean>(material.law) && material.hourglass_viscosity > 0.0)
    throw InputError("hourglass_viscosity", "neo_hookean has hourglass stiffness only");
  if (std::holds_alternative<NeoHookean>(material.law) &&
      material.linear_viscosity + material.quadratic_viscosity > 0.0)
    throw InputError("linear_viscosity", "neo_hookean has no bulk viscosity");
  if (std::holds_alternative<NeoHookean>(material.law) &&
      (formulation == Formulation::mean_dilatation || formulation == Formulation::nodal_pressure))
    throw InputError("formulation", fmt::format("neo_hookean has full or one_point, not {}", name));
}

GroupKernel make_group(const Material& material, Shape shape, Plane plane,
                       std::span<const double> lengths, bool stored) {
  GroupKernel group;
  group.kinematics = kinematics_of(material);
  KernelKey key{.shape = shape,
                .formulation = material.formulation,
                .kinematics = group.kinematics,
                .space = plane == Plane::axisymmetric ? Space::axisymmetric : Space::plane,
                .response = Response::called};
  const auto size = static_cast<std::size_t>(dimension_of(shape) == 2 ? 4 : 6);
  const auto points = static_cast<std::size_t>(num_points(shape, material.formulation));
  with_law(material, plane, [&](const auto& law) {
    using LawType = std::decay_t<decltype(law)>;
    group.parameters = std::make_shared<const LawType>(law);
    group.law.parameters = group.parameters.get();
    if constexpr (std::is_base_of_v<NeoHookean, LawType>) {
      key.response =
          plane == Plane::stress ? Response::hyperelastic_plane_stress : Response::hyperelastic;
    } else {
      constexpr bool linear = LinearLaw<LawType>;
      const bool viscous =
          material.linear_viscosity + material.quadratic_viscosity > 0.0 ||
          (material.formulation == Formulation::one_point && material.hourglass_viscosity > 0.0);
      group.increments = material.finite_strain || !linear || stored || viscous ||
                         material.formulation == Formulation::nodal_pressure;
      if constexpr (std::is_base_of_v<IsotropicElastic, LawType>)
        if (!group.increments) {
          key.response = Response::elastic;
          group.moduli = law.moduli;
          if (plane == Plane::stress) // of the three-dimensional law where sigma zz vanishes
            group.moduli.lambda *= 2.0 * law.moduli.mu / law.moduli.uniaxial();
        }
      group.law.history = group.increments ? LawType::history : 0;
      if (group.increments) {
        group.stress.assign(lengths.size() * points * size, 0.0);
        group.initial_history.resize(lengths.size() * points * LawType::history);
        for (std::size_t e = 0; e < lengths.size(); ++e) {
          const auto initial = law.initial_history(lengths[e]);
          for (std::size_t q = 0; q < points; ++q)
            for (std::size_t k = 0; k < initial.size(); ++k)
              group.initial_history[((e / batch_size * points + q) * initial.size() + k) *
                                        batch_size +
                                    e % batch_size] = initial[k];
        }
      }
    }
  });
  group.law.respond = dispatch(baseline::law_call, avx2::law_call,
                               avx512::law_call)({.law = material.law.index(),
                                                  .dim = dimension_of(shape),
                                                  .plane_stress = plane == Plane::stress,
                                                  .increments = group.increments});
  group.compute = find_kernel(key);
  if (material.formulation == Formulation::nodal_pressure) {
    key.response = Response::none;
    group.compute_dilatation = find_kernel(key);
  }
  group.points = static_cast<int>(points);
  if (material.linear_viscosity + material.quadratic_viscosity > 0.0) {
    group.length.assign(lengths.begin(), lengths.end());
    const double b_2 = material.quadratic_viscosity;
    group.constants.linear_viscosity =
        material.linear_viscosity * std::sqrt(material.density() * material.bound().uniaxial());
    group.constants.quadratic_viscosity = b_2 * b_2 * material.density();
  }
  if (material.formulation == Formulation::one_point) {
    const double stiffness = material.bound().uniaxial();
    group.constants.hourglass = material.hourglass_stiffness * stiffness;
    group.constants.hourglass_viscosity =
        material.hourglass_viscosity * std::sqrt(material.density() * stiffness);
    if (group.increments)
      group.hourglass.assign(lengths.size() * (shape == Shape::quad4 ? 2 : 12), 0.0);
  }
  return group;
}

std::vector<HistoryValue> history_of(const Material& material, Plane plane) {
  return with_law(material, plane, [&](const auto& law) {
    using LawType = std::decay_t<decltype(law)>;
    std::vector<HistoryValue> values;
    if constexpr (!std::is_base_of_v<NeoHookean, LawType>)
      for (int k = 0; k < LawType::history; ++k)
        values.push_back({LawType::history_names[static_cast<std::size_t>(k)],
                          LawType::history_units[static_cast<std::size_t>(k)]});
    return values;
  });
}

} // namespace fem
} // namespace kerf
