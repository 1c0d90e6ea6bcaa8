#include "dem_core/row_block.hpp"

namespace kerf::dem {

namespace {

/// Of a moment against relative rotation.
template <int dim> using Moment = Eigen::Matrix<double, rotations<dim>, rotations<dim>>;
/// What a motion of one body does to a displacement at the point of contact.
template <int dim> using Kinematics = Eigen::Matrix<double, dim, dofs(dim)>;

/// One side of a contact: a particle, or the free cluster that has it.
template <int dim> struct Side {
  Vec<dim> arm;  // from the centre to the point of contact, m
  double length; // of the scaled rotation, m

  Side(const Particles<dim>& p, const Clusters<dim>& clusters, std::uint32_t i,
       const Vec<dim>& own_arm)
      : arm(own_arm), length(p.radius[i]) {
    if (const Cluster<dim>* cluster = clusters.free_one_of(p, i)) {
      arm += p.position(i) - cluster->centre();
      length = cluster->extent;
    }
  }
  Kinematics<dim> kinematics() const {
    Kinematics<dim> k;
    k.template leftCols<dim>().setIdentity();
    for (int a = 0; a < rotations<dim>; ++a)
      k.col(dim + a) = spin<dim>(Rot<dim>::Unit(a), arm) / length;
    return k;
  }
};

} // namespace

template <int dim>
void RowBlock<dim>::add(const Contacts<dim>& c, const Particles<dim>& p,
                        const Clusters<dim>& clusters, std::size_t k, bool is_second) {
  const Span<dim> span = span_of(c, p, k);
  if (!c.carries(k, span.opening))
    return;
  const Vec<dim> n = span.normal();
  const ContactStiffness spring = stiffness_of(c, k, span.opening);
  const Eigen::Matrix<double, dim, dim> normal = n * n.transpose();
  const Eigen::Matrix<double, dim, dim> stiffness =
      c.weight[k] * (spring.normal * normal +
                     spring.tangential * (Eigen::Matrix<double, dim, dim>::Identity() - normal));
  const Side<dim> first(p, clusters, c.first[k], c.share[k] * span.branch);
  const Side<dim> second(p, clusters, c.second[k], (c.share[k] - 1.0) * span.branch);
  const Side<dim>&self = is_second ? second : first, &other = is_second ? first : second;
  const Kinematics<dim> of_self = self.kinematics();
  own += of_self.transpose() * stiffness * of_self;
  others += (of_self.transpose() * stiffness * other.kinematics()).cwiseAbs().rowwise().sum();
  if (spring.bending > 0.0) {
    Moment<dim> moment = c.weight[k] * spring.bending * Moment<dim>::Identity();
    if constexpr (dim == 3)
      moment += c.weight[k] * (spring.twisting - spring.bending) * normal;
    own.template bottomRightCorner<rotations<dim>, rotations<dim>>() +=
        moment / (self.length * self.length);
    others.template tail<rotations<dim>>() +=
        moment.cwiseAbs().rowwise().sum() / (self.length * other.length);
  }
}

template struct RowBlock<2>;
template struct RowBlock<3>;

} // namespace kerf::dem
