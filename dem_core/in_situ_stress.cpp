#include "dem_core/in_situ_stress.hpp"

#include "dem_core/spring_network.hpp"
#include "dem_core/stress_means.hpp"

#include <Eigen/QR>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace kerf::dem {

namespace {

/// A unit strain; shear strains are doubled, as the components of Symmetric are.
template <int dim> Matrix<dim> unit_strain(int component) {
  constexpr int shear[3][2] = {{1, 2}, {0, 2}, {0, 1}};
  const int s = dim == 2 ? 2 : component - dim;
  const int a = component < dim ? component : shear[s][0];
  const int b = component < dim ? component : shear[s][1];
  Matrix<dim> strain = Matrix<dim>::Zero();
  strain(a, b) += 0.5;
  strain(b, a) += 0.5;
  return strain;
}

/// What carries the stress: bonds, then those contacts with tools that press.
template <int dim> struct Carriers {
  std::vector<std::uint32_t> bonds;
  std::vector<Spring<dim>> walls;    // all contacts with tools, tool by tool
  std::vector<Vec<dim>> wall_normal; // of each
  std::vector<std::uint8_t> presses; // likewise
  std::vector<std::uint8_t> is_idle; // particles with too few bonds
};

/// Fewer springs than axes cannot hold a particle against any force and moment.
template <int dim>
void find_idle(const Contacts<dim>& c, Carriers<dim>& carriers, const Boundary<dim>& boundary) {
  for (bool again = true; again;) {
    std::vector<int> count(carriers.is_idle.size(), 0);
    for (const std::uint32_t k : carriers.bonds)
      for (const std::uint32_t i : {c.first[k], c.second[k]})
        ++count[i];
    for (const Spring<dim>& wall : carriers.walls)
      ++count[wall.first];
    for (std::size_t i = 0; i < count.size(); ++i)
      carriers.is_idle[i] = count[i] < dim && boundary.of(i) == nullptr;
    const std::size_t idle = std::erase_if(carriers.bonds, [&](std::uint32_t k) {
      return carriers.is_idle[c.first[k]] || carriers.is_idle[c.second[k]];
    });
    again = idle > 0;
  }
}

template <int dim>
Carriers<dim> find_carriers(const Particles<dim>& p, const Contacts<dim>& c,
                            const Boundary<dim>& boundary,
                            std::span<const WallContacts<dim>> wall_contacts) {
  Carriers<dim> carriers;
  carriers.is_idle.assign(p.size(), 0);
  for (std::uint32_t k = 0; k < c.size(); ++k)
    if (c.bonded[k])
      carriers.bonds.push_back(k);
  for (const WallContacts<dim>& list : wall_contacts)
    list.for_each([&](const WallContact<dim>& contact, const FacetContact<dim>& place) {
      carriers.walls.push_back({.first = contact.particle,
                                .branch = (p.radius[contact.particle] + place.gap) * place.normal,
                                .k_n = list.material().normal_stiffness}); // without friction
      carriers.wall_normal.push_back(place.normal);
    });
  carriers.presses.assign(carriers.walls.size(), 1);
  find_idle(c, carriers, boundary);
  return carriers;
}

template <int dim>
SpringNetwork<dim> make_network(const Particles<dim>& p, const Contacts<dim>& c,
                                const Boundary<dim>& boundary, const Carriers<dim>& carriers) {
  constexpr std::size_t unknowns = SpringNetwork<dim>::unknowns;
  std::vector<Spring<dim>> springs;
  for (const std::uint32_t k : carriers.bonds)
    springs.push_back({c.first[k], c.second[k], span_of(c, p, k).branch, c.share[k],
                       c.normal_stiffness[k], c.tangential_stiffness[k]});
  for (std::size_t k = 0; k < carriers.walls.size(); ++k)
    if (carriers.presses[k] != 0)
      springs.push_back(carriers.walls[k]);
  std::vector<std::uint8_t> is_held(p.size() * unknowns, 0);
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t a = 0; a < unknowns; ++a)
      is_held[i * unknowns + a] =
          carriers.is_idle[i] != 0 ||
          boundary.prescribes(i, static_cast<int>(std::min<std::size_t>(a, dim)));
  return {std::move(springs), std::move(is_held)};
}

/// Forces of the springs with the wanted means, in equilibrium with the loads.
template <int dim> struct Solution {
  std::vector<Vec<dim>> force; // N
  double unbalanced = 0.0;
  Eigen::VectorXd means; // Pa
};

template <int dim>
Solution<dim> solve(const SpringNetwork<dim>& network, const StressMeans<dim>& measured,
                    std::span<const Load<dim>> load) {
  const std::span<const Spring<dim>> springs = network.springs();
  const std::vector<Load<dim>> no_load(load.size());
  std::vector<std::vector<Vec<dim>>> forces; // of each strain
  Eigen::MatrixXd uniform(measured.size(), measured.size()), response = uniform;
  for (Eigen::Index k = 0; k < measured.size(); ++k) {
    const Matrix<dim> strain = unit_strain<dim>(static_cast<int>(k) % components(dim));
    std::vector<Vec<dim>>& force = forces.emplace_back();
    for (const Spring<dim>& spring : springs)
      force.push_back(spring.force(measured.shape(k, spring) * (strain * spring.branch)));
    uniform.col(k) = measured.of(springs, force);
    network.equilibrate(force, no_load);
    response.col(k) = measured.of(springs, force);
  }
  Solution<dim> s;
  s.force.assign(springs.size(), Vec<dim>::Zero());
  network.equilibrate(s.force, load);

  // Strains that what holds the body lets go do not count; they would become very large. How stiff
  // it could be is what it is while nothing moves beside the strain.
  constexpr double least = 0.02;
  const Eigen::MatrixXd scale = uniform.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::MatrixXd held = response * scale; // one where everything around the body is rigid
  Eigen::VectorXd strain = Eigen::VectorXd::Zero(measured.size());
  if (held.cwiseAbs().maxCoeff() > least) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(held.rows(), held.cols());
    solver.setThreshold(least);
    solver.compute(held);
    strain = scale * solver.solve(measured.wanted() - measured.of(springs, s.force));
  }
  for (std::size_t k = 0; k < springs.size(); ++k)
    for (Eigen::Index load_case = 0; load_case < strain.size(); ++load_case)
      s.force[k] += strain[load_case] * forces[static_cast<std::size_t>(load_case)][k];
  s.unbalanced = network.equilibrate(s.force, load);
  s.means = measured.of(springs, s.force);
  return s;
}

/// Tools do not pull: contacts that would are open.
/// @return whether there were any
template <int dim> bool open_walls(std::span<const Vec<dim>> force, Carriers<dim>& carriers) {
  bool found = false;
  std::size_t next = carriers.bonds.size();
  for (std::size_t k = 0; k < carriers.walls.size(); ++k)
    if (carriers.presses[k] != 0 && force[next++].dot(carriers.wall_normal[k]) > 0.0) {
      carriers.presses[k] = 0;
      found = true;
    }
  return found;
}

template <int dim> void check(const Solution<dim>& solution, const StressMeans<dim>& measured) {
  constexpr double most_unbalanced = 1e-9, most_wrong = 0.05;
  const Symmetric<dim> found = solution.means.template head<components(dim)>();
  const Symmetric<dim> wanted = measured.wanted().template head<components(dim)>();
  if (!((solution.means - measured.wanted()).norm() <= most_wrong * measured.wanted().norm()))
    throw ImpossibleStress(
        fmt::format("what holds the body lets it take a mean of [{:.4g}] Pa, wanted are "
                    "[{:.4g}] Pa: hold the particles at its surface by boundaries or tools, or let "
                    "space repeat",
                    fmt::join(found, ", "), fmt::join(wanted, ", ")));
  if (!(solution.unbalanced <= most_unbalanced))
    throw ImpossibleStress(fmt::format(
        "there is no equilibrium, a particle would have a resultant of {:.3g} of "
        "the mean contact force: boundaries or tools must hold the body, bonds every particle",
        solution.unbalanced));
}

/// Gives the bonds their forces.
/// @throws std::invalid_argument when one is too weak
template <int dim>
void load(std::span<const std::uint32_t> bonds, std::span<const Vec<dim>> force,
          const Particles<dim>& p, Contacts<dim>& c) {
  std::size_t weak = 0, weakest = 0;
  double most = 1.0; // force over strength
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const std::uint32_t k = bonds[b];
    const Span<dim> span = span_of(c, p, k);
    const Vec<dim> n = span.normal();
    const double F_n = force[b].dot(n);
    const Vec<dim> F_T = force[b] - F_n * n;
    c.normal_force[k] = F_n;
    c.rest_length[k] = span.length - F_n / c.normal_stiffness[k];
    if constexpr (dim == 2)
      c.shear_force.set(k, Rot<2>(F_T.dot(spin<2>(Rot<2>(1.0), n))));
    else
      c.shear_force.set(k, F_T);
    const double used = std::max(F_n / c.tensile_strength[k], F_T.norm() / c.shear_strength[k]);
    weak += used > 1.0 ? 1 : 0;
    if (used > most) {
      most = used;
      weakest = b;
    }
  }
  if (weak == 0)
    return;
  const std::uint32_t k = bonds[weakest];
  const double F_n = c.normal_force[k], F_T = c.shear_force[k].norm();
  const bool by_tension = F_n / c.tensile_strength[k] > F_T / c.shear_strength[k];
  throw ImpossibleStress(
      fmt::format("the bond of particles {} and {} would have a {} force of {:.4g} N, its "
                  "strength is {:.4g} N; {} of {} bonds are too weak",
                  p.ids[c.first[k]], p.ids[c.second[k]], by_tension ? "normal" : "shear",
                  by_tension ? F_n : F_T, by_tension ? c.tensile_strength[k] : c.shear_strength[k],
                  weak, bonds.size()));
}

/// Gives contacts with tools theirs.
/// @throws std::invalid_argument when one would be free of stress apart from the tool
template <int dim>
void load(const Carriers<dim>& carriers, std::span<const Vec<dim>> force, const Particles<dim>& p,
          std::span<WallContacts<dim>> wall_contacts) {
  std::size_t next = carriers.bonds.size(), contact = 0;
  for (WallContacts<dim>& list : wall_contacts) {
    std::vector<double> normal_force;
    list.for_each([&](const WallContact<dim>& of, const FacetContact<dim>& place) {
      const bool presses = carriers.presses[contact] != 0;
      const double F_n = presses ? force[next++].dot(carriers.wall_normal[contact]) : 0.0;
      const double k_n = list.material().normal_stiffness;
      if (F_n < k_n * place.gap)
        throw ImpossibleStress(fmt::format(
            "particle {} would press on a tool with {:.4g} N, but reaches only "
            "{:.4g} m into it, which carries {:.4g} N: let the tool reach deeper into the body",
            p.ids[of.particle], -F_n, -place.gap, -k_n * place.gap));
      normal_force.push_back(F_n);
      ++contact;
    });
    list.preload(normal_force);
  }
}

} // namespace

template <int dim>
InSituReport<dim> set_in_situ_stress(const InSituStress<dim>& stress, const Vec<dim>& gravity,
                                     std::span<const Load<dim>> loads, const Particles<dim>& p,
                                     const Boundary<dim>& boundary, const Period<dim>& period,
                                     Contacts<dim>& c, std::span<WallContacts<dim>> wall_contacts) {
  if (!stress.uniform.allFinite() ||
      !std::isfinite(stress.K0.value_or(0.0) * stress.surface * stress.overburden))
    throw ImpossibleStress("its numbers must be finite");
  if (stress.K0 && gravity.isZero(0.0))
    throw ImpossibleStress("K0 needs gravity");
  if (c.bonds() == 0)
    throw ImpossibleStress("there are no bonds that could carry it");
  const StressMeans<dim> measured(stress, gravity, p, period);
  auto carriers = find_carriers<dim>(p, c, boundary, wall_contacts);
  Solution<dim> solution;
  do
    solution = solve<dim>(make_network(p, c, boundary, carriers), measured, loads);
  while (open_walls<dim>(solution.force, carriers));
  check(solution, measured);
  load<dim>(carriers.bonds, solution.force, p, c);
  load<dim>(carriers, solution.force, p, wall_contacts);

  InSituReport<dim> report;
  report.wanted = measured.wanted().template head<components(dim)>();
  report.found = solution.means.template head<components(dim)>();
  report.bulk_density = measured.bulk_density();
  report.unbalanced = solution.unbalanced;
  report.bonds = carriers.bonds.size();
  report.wall_contacts = solution.force.size() - carriers.bonds.size();
  report.open_contacts = carriers.walls.size() - report.wall_contacts;
  report.without_stress = static_cast<std::size_t>(std::ranges::count(carriers.is_idle, 1));
  return report;
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template InSituReport<dim> set_in_situ_stress<dim>(                                              \
      const InSituStress<dim>&, const Vec<dim>&, std::span<const Load<dim>>,                       \
      const Particles<dim>&, const Boundary<dim>&, const Period<dim>&, Contacts<dim>&,             \
      std::span<WallContacts<dim>>);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

} // namespace kerf::dem
