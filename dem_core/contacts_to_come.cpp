#include "dem_core/contacts_to_come.hpp"

#include "dem_core/contact_constants.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

/// Directions of the nearest neighbours in the densest lattice.
template <int dim> std::vector<Vec<dim>> neighbour_directions() {
  std::vector<Vec<dim>> directions;
  if constexpr (dim == 2) {
    const double height = 0.5 * std::sqrt(3.0);
    for (const Vec<2>& n : {Vec<2>(1.0, 0.0), Vec<2>(0.5, height), Vec<2>(-0.5, height)})
      directions.insert(directions.end(), {n, -n});
  } else {
    for (int a = 0; a < 3; ++a)
      for (const double side : {1.0, -1.0}) {
        const Vec<3> n = (Vec<3>::Unit(a) + side * Vec<3>::Unit((a + 1) % 3)).normalized();
        directions.insert(directions.end(), {n, -n});
      }
  }
  return directions;
}

/// Row sums over the mass and the inertia (over r²) of a body with these neighbours of its own
/// size, as RowBlock has them.
template <int dim>
double row_sum_among_neighbours(const ContactStiffness& k, double mass, double rotary_mass) {
  using Square = Eigen::Matrix<double, dim, dim>;
  using Turns = Eigen::Matrix<double, dim, rotations<dim>>;
  Square own = Square::Zero();
  Eigen::Matrix<double, rotations<dim>, rotations<dim>> own_turns;
  own_turns.setZero();
  Vec<dim> moves = Vec<dim>::Zero(); // sums over the neighbours, N/m
  Rot<dim> turns = Rot<dim>::Zero();
  for (const Vec<dim>& n : neighbour_directions<dim>()) {
    const Square K =
        k.tangential * Square::Identity() + (k.normal - k.tangential) * (n * n.transpose()); // N/m
    Turns arm; // a unit turn moves the end of the arm n
    for (int r = 0; r < rotations<dim>; ++r)
      arm.col(r) = spin<dim>(Rot<dim>::Unit(r), n);
    const auto turning = (arm.transpose() * K * arm).eval();
    own += K;
    own_turns += turning;
    moves += K.cwiseAbs().rowwise().sum() + (K * arm).cwiseAbs().rowwise().sum();
    turns += turning.cwiseAbs().rowwise().sum() + (arm.transpose() * K).cwiseAbs().rowwise().sum();
  }
  // The neighbours are opposite to one another: what couples the own moves and turns cancels.
  moves += own.cwiseAbs().rowwise().sum();
  turns += own_turns.cwiseAbs().rowwise().sum();
  return std::max(mass > 0.0 ? moves.maxCoeff() / mass : 0.0,
                  rotary_mass > 0.0 ? turns.maxCoeff() / rotary_mass : 0.0);
}

/// At an overlap of a thousandth of the smaller radius, where it matters.
ContactStiffness at_work(const PairConstants& pair, double smaller) {
  const double root = pair.is_hertzian ? std::sqrt(1e-3 * smaller) : 1.0;
  const double of_force = pair.is_hertzian ? 1.5 : 1.0;
  return {of_force * root * pair.normal_stiffness, root * pair.tangential_stiffness,
          root * pair.bending_stiffness, 0.0};
}

/// Of a particle with one of the largest radius and any material.
template <int dim>
ContactStiffness stiffest(const Materials& materials, const Particles<dim>& p, std::size_t i,
                          double largest) {
  const std::size_t own = materials.is_one() ? 0 : p.material[i];
  ContactStiffness stiffest;
  for (std::size_t other = 0; other < materials.all().size(); ++other) {
    const ContactStiffness one = at_work(
        pair_constants<dim>(materials.mixture(own, other),
                            {p.density[i], materials.all()[other].density}, p.radius[i], largest),
        p.radius[i]);
    stiffest.normal = std::max(stiffest.normal, one.normal);
    stiffest.tangential = std::max(stiffest.tangential, one.tangential);
    stiffest.bending = std::max(stiffest.bending, one.bending);
  }
  return stiffest;
}

/// The longest ratio of viscosity to stiffness among the largest particles, s.
template <int dim> double dashpot_time_to_come(const Materials& materials, double largest) {
  double longest = 0.0;
  for (const Mixture& mixture : materials.mixtures()) {
    const PairConstants pair = pair_constants<dim>(
        mixture, {mixture.first.density, mixture.second.density}, largest, largest);
    const ContactStiffness k = at_work(pair, largest);
    const double stiffens = pair.is_hertzian ? std::pow(1e-3 * largest, 0.25) : 1.0;
    for (const auto& [viscosity, stiffness] : {std::pair{pair.normal_viscosity, k.normal},
                                               std::pair{pair.tangential_viscosity, k.tangential}})
      if (stiffness > 0.0)
        longest = std::max(longest, stiffens * viscosity / stiffness);
  }
  return longest;
}

} // namespace

template <int dim>
ContactsToCome contacts_to_come(const Materials& materials, const Contacts<dim>& c,
                                const Particles<dim>& p, const Boundary<dim>& boundary,
                                const Clusters<dim>& clusters) {
  const double largest = *std::max_element(p.radius.begin(), p.radius.end());
  const auto neighbours = static_cast<double>(neighbour_directions<dim>().size());
  std::vector<std::uint8_t> is_bonded(p.size(), 0);
  for (std::size_t k = 0; k < c.size(); ++k)
    if (c.was_bonded(k) || c.bonded[k])
      is_bonded[c.first[k]] = is_bonded[c.second[k]] = 1;

  ContactsToCome result;
  result.particles.assign(p.size(), 0.0);
  result.clusters.assign(clusters.size(), 0.0);
  bool is_any = false;
  const auto count = [&](std::size_t others) { // share of the neighbours that there can be
    return std::min(1.0, static_cast<double>(others) / neighbours);
  };
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.is_member(i) || is_bonded[i] != 0)
      continue;
    bool is_held = true;
    for (int a = 0; a < dim; ++a)
      is_held = is_held && boundary.prescribes(i, a);
    const double r = p.radius[i];
    const double weight = p.weight.empty() ? 1.0 : bounded_share(p.weight[i]);
    ContactStiffness k = stiffest(materials, p, i, largest);
    k.normal += k.bending / (r * r); // against turns as stiff as that, at most
    k.tangential += k.bending / (r * r);
    result.particles[i] =
        weight * count(p.size() - 1) *
        row_sum_among_neighbours<dim>(k, is_held ? 0.0 : p.mass[i],
                                      boundary.holds_rotation(i) ? 0.0 : p.inertia[i] / (r * r));
    is_any = is_any || result.particles[i] > 0.0;
  }
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const Cluster<dim>& cluster = clusters.all()[k];
    const auto bonded = [&](std::uint32_t i) { return is_bonded[i] != 0; };
    if (!cluster.is_free || std::ranges::any_of(cluster.members, bonded))
      continue;
    double stiffness = 0.0;
    for (const std::uint32_t i : cluster.members) {
      const ContactStiffness one = stiffest(materials, p, i, largest);
      stiffness = std::max({stiffness, one.normal, one.tangential});
    }
    const double mass =
        std::min(cluster.mass, cluster.least_inertia / (cluster.extent * cluster.extent));
    result.clusters[k] =
        count(p.size() - cluster.members.size()) *
        row_sum_among_neighbours<dim>({stiffness, stiffness, 0.0, 0.0}, mass, mass);
    is_any = is_any || result.clusters[k] > 0.0;
  }
  if (is_any)
    result.dashpot_time = dashpot_time_to_come<dim>(materials, largest);
  return result;
}

template ContactsToCome contacts_to_come<2>(const Materials&, const Contacts<2>&,
                                            const Particles<2>&, const Boundary<2>&,
                                            const Clusters<2>&);
template ContactsToCome contacts_to_come<3>(const Materials&, const Contacts<3>&,
                                            const Particles<3>&, const Boundary<3>&,
                                            const Clusters<3>&);

} // namespace kerf::dem
