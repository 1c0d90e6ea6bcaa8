// The assembled stiffness: its forces are those of the elements, whatever is stored of it.
#include "tests/cases/fem_bodies.hpp"

#include "fem_core/element.hpp"
#include "fem_core/stiffness_rows.hpp"

#include <gtest/gtest.h>

#include <omp.h>

#include <cstring>
#include <stdexcept>

namespace kerf::fem {
namespace {

constexpr std::size_t block = StiffnessRows<2>::rows_per_block;

/// A distorted box of more rows than fit one block, of a soft rock below and a stiff one above.
template <int dim> struct Layers {
  Mesh<dim> mesh;
  Settings<dim> settings;

  explicit Layers(Shape shape, int count = dim == 2 ? 40 : 11) {
    BoxMesh<dim> box;
    box.shape = shape;
    box.size = Vec<dim>::Constant(1e-3 * count);
    box.count.fill(static_cast<std::uint32_t>(count));
    mesh = make_box(box);
    cases::distort(mesh, box, 0.2);
    settings.materials = cases::of<dim>(IsotropicElastic::from_young(2500.0, 10e9, 0.3));
    Box<dim> above{.lower = Vec<dim>::Zero(), .upper = box.size};
    above.lower[dim - 1] = 0.5 * box.size[dim - 1];
    settings.materials.push_back(
        {.material = {.law = IsotropicElastic::from_young(3000.0, 70e9, 0.1)},
         .region = {},
         .box = above});
  }

  ElementMatrix<dim> stiffness(const Engine<dim>& engine, std::size_t element,
                               const std::vector<double>& alpha, Space space) const {
    CornerValues of_corners;
    if (!alpha.empty()) {
      const auto nodes = mesh.nodes_of_element(element);
      of_corners.resize(static_cast<Eigen::Index>(nodes.size()));
      for (std::size_t a = 0; a < nodes.size(); ++a)
        of_corners[static_cast<Eigen::Index>(a)] = alpha[nodes[a]];
    }
    const std::size_t setting = engine.material_of(static_cast<std::uint32_t>(element));
    return stiffness_of<dim>(
        {.shape = mesh.shape_of(element),
         .space = space,
         .corners = mesh.corners(element),
         .alpha = of_corners},
        Formulation::full,
        std::get<IsotropicElastic>(settings.materials[setting].material.law).moduli);
  }

  StiffnessRows<dim> rows(const std::vector<double>& alpha = {}, Space space = Space::plane) const {
    const Engine<dim> engine(mesh, settings);
    const StiffnessElements<dim> elements{
        .corners = nodes_of(mesh.blocks.front().shape),
        .rows = mesh.blocks.front().nodes,
        .stiffness = [&](std::size_t e) { return stiffness(engine, e, alpha, space); }};
    return StiffnessRows<dim>(mesh.num_nodes(), std::span(&elements, 1));
  }
};

template <int dim> Rows<dim> some_rows(std::size_t size, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1e-6, 1e-6); // m
  Rows<dim> u(size);
  for (std::size_t row = 0; row < size; ++row)
    for (int i = 0; i < dim; ++i)
      u[row][i] = any(random);
  return u;
}

template <int dim> std::vector<double> by_node(const Rows<dim>& rows) {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows.size(); ++row)
    values.insert(values.end(), rows.at(row), rows.at(row) + dim);
  return values;
}

template <int dim> Rows<dim> product(const StiffnessRows<dim>& K, const Rows<dim>& u) {
  Rows<dim> f = some_rows<dim>(K.num_rows(), 9); // is written over
  K.multiply(u.data(), f.data());
  return f;
}

template <int dim> bool same_bits(const Rows<dim>& a, const Rows<dim>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Row<dim>)) == 0;
}

template <class Kind> struct FemStiffnessRows : testing::Test {};
template <Shape of> struct OfShape {
  static constexpr Shape shape = of;
  static constexpr int dim = dimension_of(of);
};
using Shapes = testing::Types<OfShape<Shape::tri3>, OfShape<Shape::quad4>, OfShape<Shape::tet4>,
                              OfShape<Shape::hex8>>;
struct ShapeName {
  template <class Kind> static std::string GetName(int) {
    return std::string(name_of(Kind::shape));
  }
};
TYPED_TEST_SUITE(FemStiffnessRows, Shapes, ShapeName);

// The kernels of the elements compute the same sums in another order: rounding.
TYPED_TEST(FemStiffnessRows, give_the_forces_of_the_elements) {
  constexpr int dim = TypeParam::dim;
  const Layers<dim> body(TypeParam::shape);
  ASSERT_GT(body.mesh.num_nodes(), block);
  const Rows<dim> u = some_rows<dim>(body.mesh.num_nodes());
  for (const std::vector<double>& alpha :
       {std::vector<double>{}, cases::ramp(body.mesh, 2e-3, 6e-3)}) {
    Engine<dim> engine(body.mesh, body.settings);
    if (!alpha.empty())
      engine.set_weights(alpha);
    const std::vector<double> theirs = cases::forces(engine, by_node(u)), // -F^int
        ours = by_node(product(body.rows(alpha), u));
    double difference = 0.0, most = 0.0; // N
    for (std::size_t k = 0; k < ours.size(); ++k) {
      difference = std::max(difference, std::abs(ours[k] + theirs[k]));
      most = std::max(most, std::abs(theirs[k]));
    }
    EXPECT_LE(difference, 1e-13 * most);
  }
}

TYPED_TEST(FemStiffnessRows, are_symmetric_to_the_last_bit) {
  constexpr int dim = TypeParam::dim;
  const Layers<dim> body(TypeParam::shape, 3);
  const StiffnessRows<dim> rows = body.rows();
  const auto size = static_cast<Eigen::Index>(rows.num_rows()) * dim;
  Eigen::MatrixXd K(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    Rows<dim> unit(rows.num_rows());
    unit[static_cast<std::size_t>(j) / dim][j % dim] = 1.0;
    K.col(j) = Eigen::Map<const Eigen::VectorXd>(by_node(product(rows, unit)).data(), size);
  }
  EXPECT_GT(K.diagonal().minCoeff(), 0.0);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      if (i / dim != j / dim) // on the diagonal stand sums over pairs
        EXPECT_EQ(K(i, j), K(j, i));
      else
        EXPECT_NEAR(K(i, j), K(j, i), 1e-14 * K.maxCoeff());
}

// x . K y = y . K x of pairs in one block and in two; rounding of a sum of a thousand rows.
TYPED_TEST(FemStiffnessRows, do_the_same_work_both_ways_around) {
  constexpr int dim = TypeParam::dim;
  const StiffnessRows<dim> K = Layers<dim>(TypeParam::shape).rows();
  const Rows<dim> x = some_rows<dim>(K.num_rows(), 1), y = some_rows<dim>(K.num_rows(), 2);
  const Rows<dim> of_x = product(K, x), of_y = product(K, y);
  double there = 0.0, back = 0.0, size = 0.0; // J
  for (std::size_t row = 0; row < K.num_rows(); ++row) {
    there += x[row].dot(of_y[row]);
    back += y[row].dot(of_x[row]);
    size += std::abs(x[row].dot(of_y[row]));
  }
  EXPECT_NEAR(there, back, 1e-14 * size);
}

TYPED_TEST(FemStiffnessRows, give_no_force_at_all_in_a_translation) {
  constexpr int dim = TypeParam::dim;
  const StiffnessRows<dim> K = Layers<dim>(TypeParam::shape).rows();
  Rows<dim> u(K.num_rows());
  for (std::size_t row = 0; row < u.size(); ++row)
    u[row] = Vec<dim>::LinSpaced(dim, 0.1, 0.7);
  for (const double force : by_node(product(K, u)))
    EXPECT_EQ(force, 0.0);
}

TYPED_TEST(FemStiffnessRows, have_the_same_bits_for_any_number_of_threads_and_block_by_block) {
  constexpr int dim = TypeParam::dim;
  const StiffnessRows<dim> K = Layers<dim>(TypeParam::shape).rows();
  const Rows<dim> u = some_rows<dim>(K.num_rows());
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Rows<dim> alone = product(K, u);
  for (const int more : {2, 3}) {
    omp_set_num_threads(more);
    EXPECT_TRUE(same_bits(product(K, u), alone));
    Rows<dim> by_blocks(K.num_rows());
    K.for_blocks(u.data(), [&](std::size_t first, std::size_t end, const double* f) {
      std::memcpy(by_blocks.at(first), f, (end - first) * sizeof(Row<dim>));
    });
    EXPECT_TRUE(same_bits(by_blocks, alone));
  }
  omp_set_num_threads(threads);
}

// Two hundred steps of central differences, Rojek (2008) eqs 3-5; rounding of each of them.
TYPED_TEST(FemStiffnessRows, step_as_the_engine_does) {
  constexpr int dim = TypeParam::dim;
  constexpr double time_step = 1e-8; // s, far below the limit
  const Layers<dim> body(TypeParam::shape);
  const StiffnessRows<dim> K = body.rows();
  Engine<dim> engine(body.mesh, body.settings);
  Rows<dim> velocity = some_rows<dim>(K.num_rows()), u(K.num_rows()), next(K.num_rows());
  engine.start(time_step);
  engine.set_motion(by_node(u), by_node(velocity));
  const std::vector<double> mass = engine.mass();
  for (int n = 0; n < 200; ++n) {
    engine.integrate();
    K.for_blocks(u.data(), [&](std::size_t first, std::size_t end, const double* f) {
      const double span = n == 0 ? 0.5 * time_step : time_step;
      for (std::size_t row = first; row < end; ++row) {
        const Eigen::Map<const Vec<dim>> force(f + (row - first) * row_size<dim>);
        velocity[row] -= span / mass[row] * force;
        next[row] = u[row] + time_step * velocity[row];
      }
    });
    std::swap(u, next);
  }
  const std::vector<double> theirs = engine.displacement(), ours = by_node(u);
  double difference = 0.0, most = 0.0; // m
  for (std::size_t k = 0; k < ours.size(); ++k) {
    difference = std::max(difference, std::abs(ours[k] - theirs[k]));
    most = std::max(most, std::abs(theirs[k]));
  }
  EXPECT_GT(most, 0.0);
  EXPECT_LE(difference, 1e-12 * most);
}

// A null Lagrangian, see StiffnessRows: pairs are symmetric unless the moduli change around them.
TYPED_TEST(FemStiffnessRows, store_less_where_the_moduli_do_not_change) {
  constexpr int dim = TypeParam::dim;
  Layers<dim> body(TypeParam::shape);
  const std::size_t of_layers = body.rows().bytes();
  body.settings.materials.pop_back();
  const std::size_t of_one = body.rows().bytes();
  EXPECT_LT(of_one, of_layers);
  const std::vector<double> changing = cases::ramp(body.mesh, 0.0, 1.0); // all the way
  EXPECT_LT(static_cast<double>(of_one), 0.92 * static_cast<double>(body.rows(changing).bytes()));
}

template <int dim> ElementMatrix<dim> ones(int corners) {
  return ElementMatrix<dim>::Ones(corners * dim, corners * dim);
}

TEST(StiffnessRowsInput, rows_that_are_not_there_are_refused) {
  const std::vector<std::uint32_t> rows = {0, 1, 3};
  const StiffnessElements<2> element{
      .corners = 3, .rows = rows, .stiffness = [](std::size_t) { return ones<2>(3); }};
  EXPECT_THROW(StiffnessRows<2>(3, std::span(&element, 1)), std::invalid_argument);
}

TEST(StiffnessRowsInput, what_resists_translation_is_refused_as_rings_do) {
  Layers<2> body(Shape::tri3, 4);
  body.settings.materials.pop_back();
  for (std::size_t a = 0; a < body.mesh.num_nodes(); ++a)
    body.mesh.positions[2 * a] += 5e-3;
  EXPECT_NO_THROW(body.rows({}, Space::plane));
  EXPECT_THROW(body.rows({}, Space::axisymmetric), std::invalid_argument);
}

TEST(StiffnessRowsInput, a_matrix_that_is_not_symmetric_is_refused) {
  const std::vector<std::uint32_t> rows = {0, 1, 2};
  ElementMatrix<2> K = ElementMatrix<2>::Zero(6, 6);
  K(0, 2) = 1.0;
  K(0, 4) = -1.0;
  const StiffnessElements<2> element{
      .corners = 3, .rows = rows, .stiffness = [&](std::size_t) { return K; }};
  EXPECT_THROW(StiffnessRows<2>(3, std::span(&element, 1)), std::invalid_argument);
}

TEST(StiffnessRowsInput, rows_without_elements_get_no_force) {
  const StiffnessRows<3> K(5, {});
  EXPECT_EQ(product(K, some_rows<3>(5)).at(4)[0], 0.0);
}

} // namespace
} // namespace kerf::fem
