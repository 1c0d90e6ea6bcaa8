// Explicit steps of a linear body in deal.II, with MatrixFree, one MPI rank a thread:
// kerf-peer-dealii FOLDER STEPS WARM_UP
// FOLDER is as for fenicsx_steps.py. Row-sum lumped mass, 2 x 2 (x 2) Gauss points, central
// differences; the update of the nodes is part of the loop over the elements, as in step-67.
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/matrix_free/evaluation_template_factory.templates.h>
#include <deal.II/matrix_free/evaluation_template_factory_hanging_nodes.templates.h>
#include <deal.II/matrix_free/fe_evaluation.h>
#include <deal.II/matrix_free/mapping_info.templates.h>
#include <deal.II/matrix_free/mapping_info_storage.templates.h>
#include <deal.II/matrix_free/matrix_free.templates.h>
#include <deal.II/matrix_free/shape_info.templates.h>

#include <boost/property_tree/json_parser.hpp>

#include <fstream>
#include <iostream>

// MatrixFree names it, but nothing here has faces; deal.II's header for it has the guard of the one
// for elements.
namespace dealii::internal {
template <int dim, typename Number>
void FEFaceEvaluationFactory<dim, Number>::evaluate(const unsigned int,
                                                    const EvaluationFlags::EvaluationFlags,
                                                    const Number*,
                                                    FEEvaluationData<dim, Number, true>&) {
  AssertThrow(false, ExcNotImplemented());
}
} // namespace dealii::internal

using namespace dealii;
using Vector_ = LinearAlgebra::distributed::Vector<double>;

struct Model {
  std::string folder, shape;
  unsigned int corners;
  double lambda, mu, density, time_step;
};

template <class Value> std::vector<Value> read(const Model& model, const std::string& name) {
  std::ifstream file(model.folder + "/" + name, std::ios::binary);
  file.seekg(0, std::ios::end);
  std::vector<Value> values(static_cast<std::size_t>(file.tellg()) / sizeof(Value));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()), values.size() * sizeof(Value));
  return values;
}

template <int dim>
void create(parallel::shared::Triangulation<dim>& triangulation, const Model& model) {
  const auto positions = read<double>(model, "positions.bin");
  const auto elements = read<std::uint32_t>(model, "elements.bin");
  std::vector<Point<dim>> points(positions.size() / dim);
  for (std::size_t a = 0; a < points.size(); ++a)
    for (int i = 0; i < dim; ++i)
      points[a][i] = positions[a * dim + i];
  std::vector<CellData<dim>> cells(elements.size() / model.corners, CellData<dim>(model.corners));
  const bool simplex = model.corners == dim + 1;
  for (std::size_t e = 0; e < cells.size(); ++e)
    for (unsigned int a = 0; a < model.corners; ++a) {
      const unsigned int vtk = simplex || (a & 2) == 0 ? a : a ^ 1; // deal.II: lexicographic
      cells[e].vertices[a] = elements[e * model.corners + vtk];
    }
  triangulation.signals.create.connect([&] { // ranks get one piece each of the Morton curve
    const auto ranks = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    for (const auto& cell : triangulation.active_cell_iterators())
      cell->set_subdomain_id(cell->active_cell_index() * ranks / triangulation.n_active_cells());
  });
  triangulation.create_triangulation(points, cells, SubCellData());
}

/// @tparam degree  -1 for simplices
template <int dim, int degree> class Body {
public:
  using Evaluation = FEEvaluation<dim, degree, degree == -1 ? 0 : degree + 1, dim, double>;

  Body(const Model& model, const FiniteElement<dim>& element, const Mapping<dim>& mapping,
       const Quadrature<dim>& quadrature)
      : model_(model),
        triangulation_(MPI_COMM_WORLD, Triangulation<dim>::none, true,
                       parallel::shared::Triangulation<dim>::partition_custom_signal),
        dofs_(triangulation_) {
    create(triangulation_, model);
    dofs_.distribute_dofs(element);
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
    AffineConstraints<double> none(relevant);
    none.close();
    typename MatrixFree<dim>::AdditionalData data;
    data.tasks_parallel_scheme = MatrixFree<dim>::AdditionalData::none;
    data.mapping_update_flags = update_gradients | update_values | update_JxW_values;
    elements_.reinit(mapping, dofs_, none, quadrature, data);
    for (Vector_* vector : {&displacement_, &velocity_, &force_, &per_mass_})
      elements_.initialize_dof_vector(*vector);

    const auto of_nodes = read<double>(model, "velocity.bin");
    for_nodes(
        [&](types::global_dof_index dof, std::size_t place) { velocity_[dof] = of_nodes[place]; });
    const std::function<void(const MatrixFree<dim>&, Vector_&, const Vector_&,
                             const std::pair<unsigned int, unsigned int>&)>
        add_mass = [&](const auto& all, auto& mass, const auto&, const auto& range) {
          Evaluation point(all);
          Tensor<1, dim, VectorizedArray<double>> rho;
          for (int i = 0; i < dim; ++i)
            rho[i] = model_.density;
          for (unsigned int batch = range.first; batch < range.second; ++batch) {
            point.reinit(batch);
            for (unsigned int q = 0; q < point.n_q_points; ++q)
              point.submit_value(rho, q);
            point.integrate_scatter(EvaluationFlags::values, mass);
          }
        };
    elements_.cell_loop(add_mass, per_mass_, displacement_, true);
    for (double& value : per_mass_)
      value = model.time_step / value;
  }

  void step(double share) {
    elements_.cell_loop(
        &Body::add_forces, this, force_, displacement_,
        [&](unsigned int first, unsigned int end) {
          for (unsigned int i = first; i < end; ++i)
            force_.local_element(i) = 0.0;
        },
        [&](unsigned int first, unsigned int end) {
          for (unsigned int i = first; i < end; ++i) {
            velocity_.local_element(i) -=
                share * per_mass_.local_element(i) * force_.local_element(i);
            displacement_.local_element(i) += model_.time_step * velocity_.local_element(i);
          }
        });
  }

  void write_displacement() const {
    std::vector<double> of_nodes(triangulation_.n_vertices() * dim, 0.0);
    for_nodes([&](types::global_dof_index dof, std::size_t place) {
      of_nodes[place] = displacement_[dof];
    });
    Utilities::MPI::sum(of_nodes, MPI_COMM_WORLD, of_nodes);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::ofstream(model_.folder + "/displacement.bin", std::ios::binary)
          .write(reinterpret_cast<const char*>(of_nodes.data()), of_nodes.size() * sizeof(double));
  }

private:
  void add_forces(const MatrixFree<dim>& all, Vector_& force, const Vector_& displacement,
                  const std::pair<unsigned int, unsigned int>& range) const {
    Evaluation point(all);
    for (unsigned int batch = range.first; batch < range.second; ++batch) {
      point.reinit(batch);
      point.gather_evaluate(displacement, EvaluationFlags::gradients);
      for (unsigned int q = 0; q < point.n_q_points; ++q) {
        const auto strain = point.get_symmetric_gradient(q);
        auto stress = 2.0 * model_.mu * strain;
        const auto pressure = model_.lambda * trace(strain);
        for (int i = 0; i < dim; ++i)
          stress[i][i] += pressure;
        point.submit_symmetric_gradient(stress, q);
      }
      point.integrate_scatter(EvaluationFlags::gradients, force);
    }
  }

  /// Calls act(degree of freedom, place in an array [nodes][dim]) for those of this rank.
  template <class Act> void for_nodes(Act act) const {
    const IndexSet& own = dofs_.locally_owned_dofs();
    for (const auto& cell : dofs_.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int vertex : cell->vertex_indices())
          for (unsigned int i = 0; i < dim; ++i)
            if (const auto dof = cell->vertex_dof_index(vertex, i); own.is_element(dof))
              act(dof, std::size_t{cell->vertex_index(vertex)} * dim + i);
  }

  Model model_;
  parallel::shared::Triangulation<dim> triangulation_;
  DoFHandler<dim> dofs_;
  MatrixFree<dim> elements_;
  Vector_ displacement_, velocity_, force_, per_mass_;
};

template <int dim, int degree>
void run(const Model& model, const FiniteElement<dim>& element, const Mapping<dim>& mapping,
         const Quadrature<dim>& quadrature, int steps, int warm_up) {
  Body<dim, degree> body(model, element, mapping, quadrature);
  body.step(0.5);
  for (int n = 1; n < warm_up; ++n)
    body.step(1.0);
  MPI_Barrier(MPI_COMM_WORLD);
  const double start = MPI_Wtime();
  for (int n = 0; n < steps; ++n)
    body.step(1.0);
  MPI_Barrier(MPI_COMM_WORLD);
  const double seconds = MPI_Wtime() - start;
  body.write_displacement();
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "vectors of " << VectorizedArray<double>::size() << "\nLoop time of " << seconds
              << " s" << std::endl;
}

template <int dim> void run(const Model& model, int steps, int warm_up) {
  if (model.corners == dim + 1)
    run<dim, -1>(model, FESystem<dim>(FE_SimplexP<dim>(1), dim),
                 MappingFE<dim>(FE_SimplexP<dim>(1)), QGaussSimplex<dim>(1), steps, warm_up);
  else
    run<dim, 1>(model, FESystem<dim>(FE_Q<dim>(1), dim), MappingQ<dim>(1), QGauss<dim>(2), steps,
                warm_up);
}

int main(int argc, char** argv) {
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc != 4) {
    std::cerr << "usage: kerf-peer-dealii FOLDER STEPS WARM_UP" << std::endl;
    return 2;
  }
  boost::property_tree::ptree file;
  read_json(argv[1] + std::string("/model.json"), file);
  const Model model{argv[1],
                    file.get<std::string>("shape"),
                    file.get<unsigned int>("corners"),
                    file.get<double>("lambda"),
                    file.get<double>("mu"),
                    file.get<double>("density"),
                    file.get<double>("time_step")};
  const int steps = std::atoi(argv[2]), warm_up = std::atoi(argv[3]);
  if (file.get<int>("dimension") == 2)
    run<2>(model, steps, warm_up);
  else
    run<3>(model, steps, warm_up);
}
