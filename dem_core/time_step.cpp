#include "dem_core/time_step.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::dem {

namespace {

constexpr int dofs(int dim) {
  return dim == 2 ? 3 : 6;
}

/// Translations u, then scaled rotations r theta.
template <int dim> using Block = Eigen::Matrix<double, dofs(dim), dofs(dim)>;
template <int dim> using Row = Eigen::Matrix<double, dofs(dim), 1>;
/// Of a moment against relative rotation.
template <int dim> using Moment = Eigen::Matrix<double, rotations<dim>, rotations<dim>>;
/// What a motion of one particle does to the relative displacement at the point of contact.
template <int dim> using Kinematics = Eigen::Matrix<double, dim, dofs(dim)>;

/// Velocity of the rotation of `side` around the branch, per unit of r theta: -arm / r theta x n.
template <int dim> Kinematics<dim> rolling(const Vec<dim>& n, double arm_over_radius) {
  Kinematics<dim> k = Kinematics<dim>::Zero();
  for (int a = 0; a < rotations<dim>; ++a)
    k.col(dim + a) = -arm_over_radius * spin<dim>(Rot<dim>::Unit(a), n);
  return k;
}

/// Largest eigenvalue of a particle that touches a tool, without anything else, rad²/s².
template <int dim>
double wall_eigenvalue(const WallMaterial& material, const Particles<dim>& p,
                       const Boundary<dim>& boundary, std::size_t i) {
  bool is_held = true;
  for (int a = 0; a < dim; ++a)
    is_held = is_held && boundary.prescribes(i, a);
  const double translation = is_held ? 0.0 : 1.0 / p.mass[i]; // 1/kg
  const double rotation =
      boundary.holds_rotation(i) ? 0.0 : p.radius[i] * p.radius[i] / p.inertia[i]; // 1/kg
  return std::max(material.normal_stiffness * translation,
                  material.tangential_stiffness * (translation + rotation));
}

} // namespace

template <int dim>
double row_sum(const Contacts<dim>& c, const Incidence& incidence, const Particles<dim>& p,
               const Boundary<dim>& boundary, std::size_t i) {
  Block<dim> own = Block<dim>::Zero(); // summed before absolute values are taken
  Row<dim> others = Row<dim>::Zero();
  for (std::uint32_t e = incidence.offset[i]; e < incidence.offset[i + 1]; ++e) {
    const std::uint32_t k = incidence.entry[e] >> 1;
    const bool is_second = (incidence.entry[e] & 1u) != 0;
    const Span<dim> span = span_of(c, p, k);
    if (!c.carries(k, span.opening))
      continue;

    const Vec<dim> n = is_second ? Vec<dim>(-span.normal()) : span.normal(); // away from particle i
    const ContactStiffness spring = stiffness_of(c, k, span.opening);
    const double length = span.length;
    const double lever = length / (p.radius[c.first[k]] + p.radius[c.second[k]]);
    const Eigen::Matrix<double, dim, dim> normal = n * n.transpose();
    const Eigen::Matrix<double, dim, dim> stiffness =
        c.weight[k] * (spring.normal * normal +
                       spring.tangential * (Eigen::Matrix<double, dim, dim>::Identity() - normal));
    Kinematics<dim> self = rolling<dim>(n, lever), other = self;
    self.template leftCols<dim>() = -Eigen::Matrix<double, dim, dim>::Identity();
    other.template leftCols<dim>().setIdentity();
    own += self.transpose() * stiffness * self;
    others += (self.transpose() * stiffness * other).cwiseAbs().rowwise().sum();
    if (spring.bending > 0.0) {
      Moment<dim> moment = c.weight[k] * spring.bending * Moment<dim>::Identity();
      if constexpr (dim == 3)
        moment += c.weight[k] * (spring.twisting - spring.bending) * normal;
      const double r = p.radius[i], r_other = p.radius[is_second ? c.first[k] : c.second[k]];
      own.template bottomRightCorner<rotations<dim>, rotations<dim>>() += moment / (r * r);
      others.template tail<rotations<dim>>() += moment.cwiseAbs().rowwise().sum() / (r * r_other);
    }
  }

  const Row<dim> sums = own.cwiseAbs().rowwise().sum() + others;
  double largest = 0.0;
  for (int a = 0; a < dim; ++a)
    if (!boundary.prescribes(i, a))
      largest = std::max(largest, sums[a] / p.mass[i]);
  if (!boundary.holds_rotation(i)) {
    const double rotary_mass = p.inertia[i] / (p.radius[i] * p.radius[i]); // kg
    for (int a = dim; a < dofs(dim); ++a)
      largest = std::max(largest, sums[a] / rotary_mass);
  }
  return largest;
}

template <int dim> double dashpot_time(const Contacts<dim>& c, const Particles<dim>& p) {
  double longest = 0.0;
  for (std::size_t k = 0; k < c.size(); ++k) {
    const double opening = span_of(c, p, k).opening;
    if (!c.carries(k, opening))
      continue;
    const ContactStiffness spring = stiffness_of(c, k, opening);
    const double stiffens =
        c.law == ContactLaw::hertz_mindlin ? std::pow(std::max(0.0, -opening), 0.25) : 1.0;
    if (spring.normal > 0.0)
      longest = std::max(longest, stiffens * c.normal_viscosity[k] / spring.normal);
    if (spring.tangential > 0.0)
      longest = std::max(longest, stiffens * c.tangential_viscosity[k] / spring.tangential);
  }
  return longest;
}

double with_dashpots(double omega2, double time) {
  const double xi = 0.5 * std::sqrt(omega2) * time;
  const double factor = std::sqrt(1.0 + xi * xi) - xi;
  return omega2 / (factor * factor);
}

#define KERF_INSTANTIATE(dim)                                                                      \
  template double dashpot_time<dim>(const Contacts<dim>&, const Particles<dim>&);
KERF_INSTANTIATE(2)
KERF_INSTANTIATE(3)

template <int dim>
std::vector<double> wall_sums(std::span<const Tool<dim>> tools,
                              std::span<const WallContacts<dim>> contacts, const Particles<dim>& p,
                              const Boundary<dim>& boundary) {
  std::vector<double> sums(p.size(), 0.0), to_come(p.size(), 0.0);
  for (std::size_t k = 0; k < tools.size(); ++k) {
    const WallMaterial& material = contacts[k].material();
    const double stiffness = std::max(material.normal_stiffness, material.tangential_stiffness);
    const double of_one = stiffness * tools[k].mobility(tools[k].pose().reference);
    double of_tool = 0.0; // rad²/s²
    std::vector<int> count(p.size(), 0);
    contacts[k].for_each([&](const WallContact<dim>& contact, const FacetContact<dim>& place) {
      of_tool += stiffness * tools[k].mobility(tools[k].pose().to_space(place.point));
      ++count[contact.particle];
    });
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double of_particle = wall_eigenvalue(material, p, boundary, i);
      if (count[i] > 0)
        sums[i] += count[i] * of_particle + of_tool;
      else
        to_come[i] = std::max(to_come[i], of_particle + of_one);
    }
  }
  for (std::size_t i = 0; i < p.size(); ++i)
    sums[i] += to_come[i];
  return sums;
}

template double row_sum<2>(const Contacts<2>&, const Incidence&, const Particles<2>&,
                           const Boundary<2>&, std::size_t);
template double row_sum<3>(const Contacts<3>&, const Incidence&, const Particles<3>&,
                           const Boundary<3>&, std::size_t);
template std::vector<double> wall_sums<2>(std::span<const Tool<2>>,
                                          std::span<const WallContacts<2>>, const Particles<2>&,
                                          const Boundary<2>&);
template std::vector<double> wall_sums<3>(std::span<const Tool<3>>,
                                          std::span<const WallContacts<3>>, const Particles<3>&,
                                          const Boundary<3>&);

} // namespace kerf::dem
