// What elements do with fields that are known: constant stress, rigid motion, mass.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/energy.hpp"
#include "fem_core/input_error.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace kerf::fem {
namespace {

using cases::rock;

template <class Dim> struct FemElements : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
struct DimensionName {
  template <class Dim> static std::string GetName(int) {
    return Dim::value == 2 ? "quad4" : "hex8";
  }
};
TYPED_TEST_SUITE(FemElements, Dimensions, DimensionName);

/// u = G X + translation at every node.
template <int dim>
std::vector<double> linear_field(const Mesh<dim>& mesh, const Tensor<dim>& G,
                                 const Vec<dim>& translation = Vec<dim>::Zero()) {
  std::vector<double> u(mesh.positions.size());
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    Eigen::Map<Vec<dim>>(u.data() + a * dim) = G * mesh.position(a) + translation;
  return u;
}

template <int dim> double volume_of(const Mesh<dim>& mesh) {
  const Vec<dim> upper = mesh.position(mesh.num_nodes() - 1);
  return upper.prod(); // boxes of the tests begin at the origin
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}

// Patch test: R. L. Taylor et al., Int. J. Numer. Meth. Eng. 22 (1986) 39-62,
// doi:10.1002/nme.1620220105. Exact in real numbers; the tolerance is the rounding of some sums.
TYPED_TEST(FemElements, carry_a_linear_displacement_as_constant_stress_without_residual_inside) {
  constexpr int dim = TypeParam::value;
  const Mesh<dim> mesh = cases::distorted_box<dim>();
  const Elements<dim> elements = make_elements(mesh);
  Tensor<dim> G;
  for (int i = 0; i < dim * dim; ++i)
    G(i / dim, i % dim) = 1e-4 * (i + 1);
  const std::vector<double> u = linear_field<dim>(mesh, G, Vec<dim>::Constant(1e-6));

  const Tensor<dim> strain = 0.5 * (G + G.transpose());
  const Tensor<dim> sigma =
      4e9 * strain.trace() * Tensor<dim>::Identity() + 2.0 * 4e9 * strain; // lambda = mu = 4 GPa
  for (std::size_t e = 0; e < elements.size(); ++e)
    EXPECT_LE((element_stress(elements, rock, std::span<const double>(u), e) - sigma).norm(),
              1e-12 * sigma.norm());

  std::set<std::uint32_t> outside;
  for (const auto& [tag, faces] : mesh.boundary)
    outside.insert(faces.begin(), faces.end());
  const std::vector<double> f = cases::forces<dim>(elements, rock, u);
  for (std::uint32_t a = 0; a < mesh.num_nodes(); ++a) {
    if (outside.contains(a))
      continue;
    for (int i = 0; i < dim; ++i)
      EXPECT_LE(std::abs(f[a * dim + i]), 1e-12 * largest(f)) << "node " << a;
  }

  // 1/2 eps : C : eps times the volume.
  const double energy = 0.5 * sigma.cwiseProduct(strain).sum() * volume_of(mesh);
  EXPECT_NEAR(elastic_energy<dim>(elements, rock, u), energy, 1e-12 * energy);
}

// Translation leaves no difference between nodes: exactly no force. Rotation leaves differences
// whose strains cancel; what is left is rounding, compared with eps times stiffness times
// displacement.
TYPED_TEST(FemElements, feel_no_force_in_rigid_translation_and_small_rotation) {
  constexpr int dim = TypeParam::value;
  const Mesh<dim> mesh = cases::distorted_box<dim>();
  const Elements<dim> elements = make_elements(mesh);
  const auto translated = linear_field<dim>(mesh, Tensor<dim>::Zero(), Vec<dim>::Constant(1e-3));
  EXPECT_EQ(largest(cases::forces<dim>(elements, rock, translated)), 0.0);

  Tensor<dim> spin = Tensor<dim>::Zero();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < i; ++j)
      spin(j, i) = -(spin(i, j) = 1e-3 * (i + j));
  const auto rotated = linear_field<dim>(mesh, spin);
  const double k = cases::stiffness(elements, rock).diagonal().maxCoeff(); // N/m
  EXPECT_LE(largest(cases::forces<dim>(elements, rock, rotated)), 1e-14 * k * largest(rotated));
}

// The 2-point rule integrates alpha det J, cubic along each axis, exactly; and the shape functions
// reproduce a linear alpha on any mesh. Tolerance: rounding of the sums.
TYPED_TEST(FemElements, have_lumped_masses_that_add_up_to_the_mass_blended_too) {
  constexpr int dim = TypeParam::value;
  const Mesh<dim> mesh = cases::distorted_box<dim>();
  const double whole = 2500.0 * volume_of(mesh);
  const auto sum = [](const std::vector<double>& mass) {
    return std::accumulate(mass.begin(), mass.end(), 0.0);
  };
  EXPECT_NEAR(sum(lumped_mass(make_elements(mesh), 2500.0)), whole, 1e-13 * whole);

  const double length = mesh.position(mesh.num_nodes() - 1)[0];
  const std::vector<double> alpha = cases::ramp(mesh, 0.0, length); // mean 1/2
  EXPECT_NEAR(sum(lumped_mass(make_elements<dim>(mesh, alpha), 2500.0)), 0.5 * whole,
              1e-13 * whole);
}

// Maxwell-Betti: the forces of a linear elastic body have a symmetric stiffness, and the energy is
// half of displacement times force; the element matrices are those of the forces.
TYPED_TEST(FemElements, have_forces_that_derive_from_their_energy) {
  constexpr int dim = TypeParam::value;
  const Mesh<dim> mesh = cases::distorted_box<dim>();
  const std::vector<double> alpha = cases::ramp(mesh, 0.0, 4e-3);
  const Elements<dim> elements = make_elements<dim>(mesh, alpha);
  const Eigen::MatrixXd K = cases::stiffness(elements, rock);
  EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());

  const Eigen::VectorXd u = Eigen::VectorXd::Random(K.rows()) * 1e-6;
  const double energy = 0.5 * u.dot(K * u);
  EXPECT_NEAR(elastic_energy<dim>(elements, rock, std::span(u.data(), mesh.positions.size())),
              energy, 1e-12 * energy);

  Eigen::MatrixXd assembled = Eigen::MatrixXd::Zero(K.rows(), K.rows());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto of_element = element_stiffness(elements, e, rock);
    const std::uint32_t* nodes = elements.nodes.data() + e * element_nodes<dim>;
    for (int a = 0; a < element_nodes<dim>; ++a)
      for (int b = 0; b < element_nodes<dim>; ++b)
        assembled.block<dim, dim>(nodes[a] * dim, nodes[b] * dim) +=
            of_element.template block<dim, dim>(a * dim, b * dim);
  }
  EXPECT_LE((K - assembled).cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff());
}

TYPED_TEST(FemElements, are_left_out_where_alpha_is_zero_at_all_their_nodes) {
  constexpr int dim = TypeParam::value;
  BoxMesh<dim> box{.size = Vec<dim>::Constant(4.0)};
  box.count.fill(4);
  const Mesh<dim> mesh = make_box(box);
  const Elements<dim> elements = make_elements<dim>(mesh, cases::ramp(mesh, 2.0, 1.0));
  EXPECT_EQ(elements.size(), mesh.num_elements() / 2);
  EXPECT_EQ(elements.number[0], 2u); // x fastest: the first two of a row are out
  const std::vector<double> mass = lumped_mass(elements, 1.0);
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    EXPECT_EQ(mass[a] > 0.0, mesh.position(a)[0] > 1.5) << "node " << a;
}

TYPED_TEST(FemElements, refuse_an_element_that_is_turned_inside_out_and_alpha_out_of_range) {
  constexpr int dim = TypeParam::value;
  BoxMesh<dim> box{.size = Vec<dim>::Constant(1.0)};
  box.count.fill(2);
  Mesh<dim> mesh = make_box(box);
  const std::vector<double> too_much(mesh.num_nodes(), 1.5);
  const std::vector<double> too_few(mesh.num_nodes() - 1, 1.0);
  EXPECT_THROW(make_elements<dim>(mesh, too_much), std::invalid_argument);
  EXPECT_THROW(make_elements<dim>(mesh, too_few), std::invalid_argument);
  std::swap(mesh.elements[0], mesh.elements[1]);
  EXPECT_THROW(make_elements(mesh), std::invalid_argument);
}

// E and nu against lambda and mu: plane strain has C11 = E (1 - nu) / ((1 + nu)(1 - 2 nu)) and
// C12 = E nu / ((1 + nu)(1 - 2 nu)).
TEST(LinearElasticLaw, is_the_same_from_engineering_constants_and_from_moduli) {
  const LinearElastic a = from_young(2500.0, 10e9, 0.25);
  const LinearElastic b = from_moduli(2500.0, 12e9, 4e9, 2);
  EXPECT_DOUBLE_EQ(a.lambda, b.lambda);
  EXPECT_DOUBLE_EQ(a.mu, b.mu);
}

TEST(LinearElasticLaw, refuses_constants_with_which_a_strain_would_give_energy) {
  EXPECT_THROW(from_young(0.0, 10e9, 0.25), InputError);
  EXPECT_THROW(from_young(2500.0, -1.0, 0.25), InputError);
  EXPECT_THROW(from_young(2500.0, 10e9, 0.5), InputError);
  EXPECT_THROW(from_moduli(2500.0, 1e9, 1e9, 2), InputError);
  EXPECT_THROW(from_moduli(2500.0, 1e9, -1e9, 2), InputError);
  EXPECT_THROW(from_moduli(2500.0, 1e9, -0.6e9, 3), InputError);
  EXPECT_NO_THROW(from_moduli(2500.0, 1e9, -0.6e9, 2));
}

} // namespace
} // namespace kerf::fem
