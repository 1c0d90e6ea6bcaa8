// The models that kerf bench fem times are what they are said to be, and its command line is read.
#include "tests/benchmarks/fem_models.hpp"
#include "tests/benchmarks/options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace kerf::benchmarks {
namespace {

template <class Act> void for_all_workloads(Act act) {
  for (const FemWorkload& workload : fem_workloads()) {
    SCOPED_TRACE(workload.name);
    if (fem::dimension_of(workload.shape) == 2)
      act(workload, std::integral_constant<int, 2>());
    else
      act(workload, std::integral_constant<int, 3>());
  }
}

// The cube or square of whole cells with about so many elements: 4^3 and 8^2 cells are wanted. That
// masses add up to the mass of it holds for lumped linear elements of any form.
TEST(BenchmarkModels, fill_a_cube_or_square_with_the_wanted_elements) {
  for_all_workloads([](const FemWorkload& workload, auto dim) {
    const std::size_t cells = 64, edges = dim() == 2 ? 8 : 4;
    const std::size_t of_cell = workload.shape == fem::Shape::tet4   ? 6
                                : workload.shape == fem::Shape::tri3 ? 2
                                                                     : 1;
    const auto mesh = mesh_of<dim()>(workload.shape, cells * of_cell);
    EXPECT_EQ(mesh.num_elements(), cells * of_cell);
    EXPECT_EQ(mesh.num_nodes(), static_cast<std::size_t>(std::pow(edges + 1, dim())));
    const auto mass = engine_of<dim()>(workload, "linear", mesh).mass();
    const double whole = 2500.0 * static_cast<double>(cells) * std::pow(cell_edge, dim());
    EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0), whole, 1e-13 * whole);
  });
}

// An isotropic solid is the same whether its law is written for layers or not, to the rounding of
// 40 steps; but hourglass control takes the bound of the moduli, which for layers is up to 0.5 %
// higher. Finite strain differs by the strain, 0.3 %, times some small factor.
TEST(BenchmarkModels, move_in_the_same_way_with_every_law_until_they_flow) {
  for_all_workloads([](const FemWorkload& workload, auto dim) {
    const auto mesh = mesh_of<dim()>(workload.shape, 500);
    const auto moved = [&](const char* law, int steps) {
      auto engine = engine_of<dim()>(workload, law, mesh);
      for (int n = 0; n < steps; ++n)
        engine.integrate();
      const auto u = engine.displacement();
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()));
    };
    const Eigen::VectorXd linear = moved("linear", 40);
    const double most = linear.cwiseAbs().maxCoeff();
    const bool hourglass = workload.formulation == fem::Formulation::one_point;
    EXPECT_LE((moved("total_strain", 40) - linear).cwiseAbs().maxCoeff(),
              (hourglass ? 5e-3 : 1e-12) * most);
    EXPECT_LE((moved("neo_hookean", 40) - linear).cwiseAbs().maxCoeff(), 0.02 * most);
    EXPECT_LE((moved("j2", 4) - moved("linear", 4)).cwiseAbs().maxCoeff(), 1e-12 * most);
    EXPECT_GT((moved("j2", 40) - linear).cwiseAbs().maxCoeff(), 0.02 * most);
    EXPECT_LE((moved("j2_finite", 40) - moved("j2", 40)).cwiseAbs().maxCoeff(), 0.02 * most);
  });
}

TEST(BenchmarkModels, flow_in_most_of_the_body_within_a_timed_block) {
  for_all_workloads([](const FemWorkload& workload, auto dim) {
    auto engine = engine_of<dim()>(workload, "j2", mesh_of<dim()>(workload.shape, 500));
    for (int n = 0; n < 60; ++n)
      engine.integrate();
    std::size_t flown = 0;
    for (const std::uint32_t e : engine.active_elements())
      flown += engine.element_state(e).history.front() > 0.0;
    EXPECT_GT(static_cast<double>(flown), 0.5 * static_cast<double>(engine.mesh().num_elements()));
  });
}

// All time steps are the same tenth, so it must be stable for the stiffest mesh of full size: by
// the bound of the elements, with their distortion.
TEST(BenchmarkModels, are_stable) {
  for_all_workloads([](const FemWorkload& workload, auto dim) {
    const auto engine = engine_of<dim()>(workload, "linear", mesh_of<dim()>(workload.shape, 3000));
    EXPECT_LT(fem_time_step(), 0.8 * 2.0 / std::sqrt(engine.step_limit().omega2));
  });
}

Options read(const std::string& line) {
  Options options;
  parser_of(options)->parse(line);
  return options;
}

TEST(BenchmarkOptions, say_what_is_timed) {
  const Options options =
      read("fem --workloads hex8,tri3 --laws j2 --threads 2 --rounds 3 --large --json f.json");
  EXPECT_EQ(options.command, "fem");
  EXPECT_EQ(options.fem.workloads, (std::vector<std::string>{"hex8", "tri3"}));
  EXPECT_EQ(options.fem.laws, std::vector<std::string>{"j2"});
  EXPECT_EQ(options.fem.threads, std::vector<int>{2});
  EXPECT_EQ(options.fem.rounds, 3);
  EXPECT_TRUE(options.fem.large);
  EXPECT_FALSE(options.fem.peers);
  EXPECT_EQ(options.json_file, "f.json");
  EXPECT_EQ(read("dem --sweep").command, "dem");
  EXPECT_TRUE(read("dem --sweep").sweep);
  EXPECT_EQ(read("exchange --points 10").points, 10);
}

TEST(BenchmarkOptions, that_make_no_sense_are_told_with_what_is_allowed) {
  const auto error_of = [](const std::string& line) -> std::string {
    try {
      read(line);
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("fem --workloads hex9"),
            "--workloads: hex9 not in {hex8,hex8_one_point,tet4,tri3,quad4}");
  EXPECT_NE(error_of("fem --laws steel").find("j2_finite"), std::string::npos);
  EXPECT_NE(error_of("fem --sweep --peers"), "");
  EXPECT_NE(error_of("fem --threads 0"), "");
  EXPECT_NE(error_of(""), "");
}

} // namespace
} // namespace kerf::benchmarks
