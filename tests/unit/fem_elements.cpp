// What elements of every shape and formulation do with fields that are known: constant stress,
// rigid motion, mass; and that the kernels compute what the formulas of one element say.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/input_error.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <functional>
#include <numeric>
#include <set>

namespace kerf::fem {
namespace {

using cases::rock;

/// A kind of element.
struct Kind {
  Shape shape;
  Formulation formulation;
  Plane plane;
};

std::vector<Kind> kinds(int dim) {
  std::vector<Kind> all;
  for (const Shape shape : {Shape::tri3, Shape::quad4, Shape::tet4, Shape::hex8}) {
    if (dimension_of(shape) != dim)
      continue;
    for (const Plane plane : {Plane::strain, Plane::stress, Plane::axisymmetric})
      for (const Formulation formulation : {Formulation::full, Formulation::mean_dilatation,
                                            Formulation::one_point, Formulation::nodal_pressure}) {
        try {
          check(Material{.law = rock, .formulation = formulation}, shape, plane);
          all.push_back({shape, formulation, plane});
        } catch (const InputError&) {
        }
      }
    if (dim == 3)
      all.resize(static_cast<std::size_t>(
          std::remove_if(all.begin(), all.end(),
                         [](const Kind& k) { return k.plane != Plane::strain; }) -
          all.begin()));
  }
  return all;
}

/// Whether the stress is stored, so that forces are those of an increment.
bool stores(const Kind& kind) {
  return kind.formulation == Formulation::nodal_pressure;
}

std::string name_of(const Kind& kind) {
  return fmt::format("{}, formulation {}, plane {}", name_of(kind.shape),
                     static_cast<int>(kind.formulation), static_cast<int>(kind.plane));
}

template <int dim>
Engine<dim> body(const Kind& kind, const Law& law = rock, bool finite_strain = false) {
  Settings<dim> settings{.materials = cases::of<dim>(law, kind.formulation, finite_strain),
                         .plane = kind.plane};
  Mesh<dim> mesh = cases::distorted_box<dim>(kind.shape);
  if (kind.plane == Plane::axisymmetric) // a ring
    for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
      mesh.positions[a * dim] += 5e-3;
  return Engine<dim>(mesh, settings);
}

template <class Dim> struct FemElements : testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
struct DimensionName {
  template <class Dim> static std::string GetName(int) { return Dim::value == 2 ? "2D" : "3D"; }
};
TYPED_TEST_SUITE(FemElements, Dimensions, DimensionName);

template <int dim> using Tensor = Eigen::Matrix<double, dim, dim>;

/// u = G X + translation at every node.
template <int dim>
std::vector<double> linear_field(const Mesh<dim>& mesh, const Tensor<dim>& G,
                                 const Vec<dim>& translation = Vec<dim>::Zero()) {
  std::vector<double> u(mesh.positions.size());
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    Eigen::Map<Vec<dim>>(u.data() + a * dim) = G * mesh.position(a) + translation;
  return u;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}

/// Largest force at nodes that are not on the outside, over the largest of all.
template <int dim> double residual_inside(const Mesh<dim>& mesh, const std::vector<double>& f) {
  std::set<std::uint32_t> outside;
  for (const auto& [tag, faces] : mesh.boundary)
    for (const Face& face : faces)
      for (const std::uint32_t a : mesh.nodes_of_face(face))
        outside.insert(a);
  double most = 0.0;
  for (std::uint32_t a = 0; a < mesh.num_nodes(); ++a)
    for (int i = 0; i < dim && !outside.contains(a); ++i)
      most = std::max(most, std::abs(f[a * dim + static_cast<std::size_t>(i)]));
  return most / largest(f);
}

template <int dim> Tensor<dim> some_gradient(double size) {
  Tensor<dim> G;
  for (int i = 0; i < dim * dim; ++i)
    G(i / dim, i % dim) = size * (i + 1);
  return G;
}

// Patch test: R. L. Taylor et al., Int. J. Numer. Meth. Eng. 22 (1986) 39-62,
// doi:10.1002/nme.1620220105. Exact in real numbers; the tolerance is the rounding of some sums.
// Strain and stress of a ring are not constant in a linear field.
TYPED_TEST(FemElements, carry_a_linear_displacement_as_constant_stress_without_residual_inside) {
  constexpr int dim = TypeParam::value;
  const Tensor<dim> G = some_gradient<dim>(1e-4), strain = 0.5 * (G + G.transpose());
  for (const Kind& kind : kinds(dim)) {
    if (kind.plane == Plane::axisymmetric)
      continue;
    SCOPED_TRACE(name_of(kind));
    Engine<dim> engine = body<dim>(kind);
    const auto u = linear_field<dim>(engine.mesh(), G, Vec<dim>::Constant(1e-6));
    const std::vector<double> f = cases::forces(engine, u, stores(kind));
    EXPECT_LE(residual_inside(engine.mesh(), f), 2e-12);

    const double lambda = kind.plane == Plane::stress ? 8.0 / 3.0 * 1e9 : 4e9; // 2 l m / (l + 2 m)
    const Tensor<dim> sigma =
        lambda * strain.trace() * Tensor<dim>::Identity() + 2.0 * 4e9 * strain;
    for (const std::uint32_t e : engine.active_elements()) {
      const auto stress = engine.element_state(e).stress;
      EXPECT_NEAR(stress[0], sigma(0, 0), 1e-12 * sigma.norm());
      EXPECT_NEAR(stress[1], sigma(1, 1), 1e-12 * sigma.norm());
      EXPECT_NEAR(stress[stress.size - 1], sigma(0, 1), 1e-12 * sigma.norm());
    }
    double energy = 0.0; // 1/2 eps : C : eps times the volume
    for (const std::uint32_t e : engine.active_elements())
      energy += engine.element_state(e).energy;
    const Vec<dim> size = Vec<dim>::LinSpaced(dim, 3.0, 5.0) * 1e-3;
    const double exact = 0.5 * sigma.cwiseProduct(strain).sum() * size.prod();
    EXPECT_NEAR(energy, exact, 1e-12 * exact);
    EXPECT_NEAR(engine.energies().elastic, exact, 1e-12 * exact);
  }
}

// The same in finite strain: an increment of 1 % and more, and a hyperelastic body.
TYPED_TEST(FemElements, pass_the_patch_test_in_finite_strain) {
  constexpr int dim = TypeParam::value;
  const Tensor<dim> G = some_gradient<dim>(1e-2);
  for (const Kind& kind : kinds(dim))
    for (const Law& law : {Law(rock), Law(NeoHookean::from(rock))}) {
      if (kind.plane == Plane::axisymmetric ||
          ((kind.formulation == Formulation::mean_dilatation || stores(kind)) && law.index() == 2))
        continue;
      SCOPED_TRACE(name_of(kind) + fmt::format(", law {}", law.index()));
      Engine<dim> engine = body<dim>(kind, law, true);
      const auto f = cases::forces(engine, linear_field<dim>(engine.mesh(), G), true);
      EXPECT_LE(residual_inside(engine.mesh(), f), 2e-12);
    }
}

// F = R U: stress of a stretch, then turned. A rigid rotation of any size leaves a hyperelastic
// body without force; rounding of F - 1 in terms of the moduli.
TYPED_TEST(FemElements, feel_no_force_in_a_large_rotation_when_they_are_hyperelastic) {
  constexpr int dim = TypeParam::value;
  Tensor<dim> R = Tensor<dim>::Identity();
  R.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  if constexpr (dim == 3)
    R = Eigen::AngleAxisd(1.1, Vec<3>(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  for (const Kind& kind : kinds(dim)) {
    if (kind.plane == Plane::axisymmetric || kind.formulation == Formulation::mean_dilatation ||
        stores(kind))
      continue;
    SCOPED_TRACE(name_of(kind));
    Engine<dim> engine = body<dim>(kind, NeoHookean::from(rock), true);
    const auto u = linear_field<dim>(engine.mesh(), R - Tensor<dim>::Identity());
    const double area = std::pow(3e-3, dim - 1);
    EXPECT_LE(largest(cases::forces(engine, u, stores(kind))), 1e-14 * 10e9 * area);
  }
}

// Translation leaves no difference between nodes: exactly no force. Rotation leaves differences
// whose strains cancel; what is left is rounding, compared with eps times stiffness times
// displacement.
TYPED_TEST(FemElements, feel_no_force_in_rigid_translation_and_small_rotation) {
  constexpr int dim = TypeParam::value;
  for (const Kind& kind : kinds(dim)) {
    SCOPED_TRACE(name_of(kind));
    Engine<dim> engine = body<dim>(kind);
    const bool ring = kind.plane == Plane::axisymmetric; // moves along its axis only
    const Vec<dim> translation =
        ring ? Vec<dim>(Vec<dim>::Unit(1) * 1e-3) : Vec<dim>::Constant(1e-3);
    const auto translated = linear_field<dim>(engine.mesh(), Tensor<dim>::Zero(), translation);
    EXPECT_EQ(largest(cases::forces(engine, translated, stores(kind))), 0.0);
    if (ring)
      continue;
    Tensor<dim> spin = Tensor<dim>::Zero();
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < i; ++j)
        spin(j, i) = -(spin(i, j) = 1e-3 * (i + j));
    const auto rotated = linear_field<dim>(engine.mesh(), spin);
    const double k = cases::stiffness(engine, stores(kind)).diagonal().maxCoeff(); // N/m
    EXPECT_LE(largest(cases::forces(engine, rotated, stores(kind))), 2e-14 * k * largest(rotated));
  }
}

// The 2-point rule integrates alpha det J, cubic along each axis, exactly; and the shape functions
// reproduce a linear alpha on any mesh. Tolerance: rounding of the sums.
TYPED_TEST(FemElements, have_lumped_masses_that_add_up_to_the_mass_blended_too) {
  constexpr int dim = TypeParam::value;
  const Vec<dim> size = Vec<dim>::LinSpaced(dim, 3.0, 5.0) * 1e-3;
  const double whole = 2500.0 * size.prod();
  const auto sum = [](const std::vector<double>& mass) {
    return std::accumulate(mass.begin(), mass.end(), 0.0);
  };
  for (const Kind& kind : kinds(dim)) {
    SCOPED_TRACE(name_of(kind));
    Engine<dim> engine = body<dim>(kind);
    const double ring =
        kind.plane == Plane::axisymmetric ? 2.0 * std::numbers::pi * 6.5e-3 : 1.0; // Guldin's rule
    EXPECT_NEAR(sum(engine.mass()), whole * ring, 1e-13 * whole * ring);
    if (kind.plane == Plane::axisymmetric)
      continue;
    engine.set_weights(cases::ramp(engine.mesh(), 0.0, size[0])); // mean 1/2
    EXPECT_NEAR(sum(engine.mass()), 0.5 * whole, 1e-13 * whole);
  }
}

// Maxwell-Betti: the forces of a linear elastic body have a symmetric stiffness, and the energy is
// half of displacement times force; the matrices of single elements, which bound the time step, are
// those of the forces.
TYPED_TEST(FemElements, have_forces_that_derive_from_their_energy) {
  constexpr int dim = TypeParam::value;
  for (const Kind& kind : kinds(dim))
    for (const bool blended : {false, true}) {
      SCOPED_TRACE(name_of(kind) + (blended ? ", blended" : ""));
      Engine<dim> engine = body<dim>(kind);
      const double first = kind.plane == Plane::axisymmetric ? 5e-3 : 0.0;
      const std::vector<double> alpha = cases::ramp(engine.mesh(), first, 4e-3);
      if (blended)
        engine.set_weights(alpha);
      const Eigen::MatrixXd K = cases::stiffness(engine, stores(kind));
      EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());

      const Eigen::VectorXd u = Eigen::VectorXd::Random(K.rows()) * 1e-6;
      const double energy = 0.5 * u.dot(K * u);
      cases::forces(engine, std::vector<double>(u.begin(), u.end()), stores(kind));
      EXPECT_NEAR(engine.energies().elastic + engine.energies().hourglass, energy, 1e-12 * energy);

      Moduli moduli = rock.moduli;
      if (kind.plane == Plane::stress)
        moduli.lambda *= 2.0 * moduli.mu / moduli.uniaxial();
      Eigen::MatrixXd assembled = Eigen::MatrixXd::Zero(K.rows(), K.rows());
      for (const std::uint32_t e : engine.active_elements()) {
        const auto nodes = engine.mesh().nodes_of_element(e);
        Element<dim> element{.shape = kind.shape,
                             .space = kind.plane == Plane::axisymmetric ? Space::axisymmetric
                                                                        : Space::plane,
                             .corners = engine.mesh().corners(e),
                             .alpha = {}};
        if (blended) {
          element.alpha.resize(static_cast<Eigen::Index>(nodes.size()));
          for (std::size_t a = 0; a < nodes.size(); ++a)
            element.alpha[static_cast<Eigen::Index>(a)] = alpha[nodes[a]];
        }
        const auto of_element =
            stiffness_of(element, kind.formulation, moduli, 0.1 * rock.moduli.uniaxial());
        for (std::size_t a = 0; a < nodes.size(); ++a)
          for (std::size_t b = 0; b < nodes.size(); ++b)
            assembled.block<dim, dim>(nodes[a] * dim, nodes[b] * dim) +=
                of_element.template block<dim, dim>(static_cast<Eigen::Index>(a) * dim,
                                                    static_cast<Eigen::Index>(b) * dim);
      }
      if (!(blended && kind.formulation == Formulation::one_point) && // shares its mean alpha
          !stores(kind)) {                                            // elements work together
        EXPECT_LE((K - assembled).cwiseAbs().maxCoeff(), 1e-13 * K.cwiseAbs().maxCoeff());
      }
    }
}

// Small increments of a law with a rate add up to the small strain of the elastic law: the stored
// stress of one step of 1e-9 differs by the rotation and the change of the volume, 1e-9 of it.
TYPED_TEST(FemElements, answer_a_tiny_increment_in_finite_strain_like_small_strain) {
  constexpr int dim = TypeParam::value;
  for (const Kind& kind : kinds(dim)) {
    SCOPED_TRACE(name_of(kind));
    Engine<dim> small = body<dim>(kind), finite = body<dim>(kind, rock, true);
    const auto size = static_cast<Eigen::Index>(small.mesh().positions.size());
    const Eigen::VectorXd random = Eigen::VectorXd::Random(size) * 1e-12;
    const std::vector<double> u(random.begin(), random.end());
    const auto f = cases::forces(small, u, stores(kind)), g = cases::forces(finite, u, true);
    double difference = 0.0;
    for (std::size_t k = 0; k < f.size(); ++k)
      difference = std::max(difference, std::abs(f[k] - g[k]));
    EXPECT_LE(difference, 2e-8 * largest(f));
    EXPECT_GT(largest(f), 0.0);
  }
}

TYPED_TEST(FemElements, are_left_out_where_alpha_is_zero_at_all_their_nodes) {
  constexpr int dim = TypeParam::value;
  BoxMesh<dim> box{.size = Vec<dim>::Constant(4.0)};
  box.count.fill(4);
  const Mesh<dim> mesh = make_box(box);
  Engine<dim> engine(mesh, {.materials = cases::of<dim>(rock)});
  engine.set_weights(cases::ramp(mesh, 2.0, 1.0));
  EXPECT_EQ(engine.active_elements().size(), mesh.num_elements() / 2);
  EXPECT_EQ(engine.active_elements()[0], 2u); // x fastest: the first two of a row are out
  const std::vector<double> mass = engine.mass();
  for (std::size_t a = 0; a < mesh.num_nodes(); ++a)
    EXPECT_EQ(mass[a] > 0.0, mesh.position(a)[0] > 1.5) << "node " << a;
}

TYPED_TEST(FemElements, refuse_an_element_that_is_turned_inside_out_and_alpha_out_of_range) {
  constexpr int dim = TypeParam::value;
  BoxMesh<dim> box{.size = Vec<dim>::Constant(1.0)};
  box.count.fill(2);
  Mesh<dim> mesh = make_box(box);
  Engine<dim> engine(mesh, {.materials = cases::of<dim>(rock)});
  const std::vector<double> too_much(mesh.num_nodes(), 1.5);
  const std::vector<double> too_few(mesh.num_nodes() - 1, 1.0);
  EXPECT_THROW(engine.set_weights(too_much), std::invalid_argument);
  EXPECT_THROW(engine.set_weights(too_few), std::invalid_argument);
  std::swap(mesh.blocks[0].nodes[0], mesh.blocks[0].nodes[1]);
  EXPECT_THROW(Engine<dim>(mesh, {.materials = cases::of<dim>(rock)}), std::invalid_argument);
}

} // namespace
} // namespace kerf::fem
