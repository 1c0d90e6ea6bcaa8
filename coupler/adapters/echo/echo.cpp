// kerf-echo: the smallest participant. It has free masses on a line that feel nothing but the
// coupling. Whoever wants to bring a solver to kerf can start from this file: put your own
// points, forces and integration where the masses are.
#include "coupler/participant/participant.hpp"

#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

using namespace kerf::coupler;

namespace {

using Rows = std::vector<double>; // [points][dimension], row by row

int run(Participant& me, std::size_t points, int dimension) {
  // 1. What the case says: its own part, and your table with every default, as JSON.
  const auto about_case = nlohmann::json::parse(me.assignment().case_settings);
  const auto settings = nlohmann::json::parse(me.assignment().settings);
  dimension = about_case.value("dimension", dimension);
  points = settings.value("points", points);
  const double spacing = settings.value("spacing", 1e-3); // m
  const double mass = 1.0;                                // kg, of each
  const auto dim = static_cast<std::size_t>(dimension);

  // 2. Declare what you have. Particles have radii; a mesh has elements and tagged faces instead.
  Declaration mine;
  mine.dimension = dimension;
  mine.positions.resize(points * dim);
  for (std::size_t i = 0; i < points; ++i) {
    mine.ids.push_back(static_cast<std::int64_t>(i));
    mine.positions[i * dim] = static_cast<double>(i) * spacing;
  }
  mine.radii.assign(points, spacing / 2);
  mine.stiffness.assign(points, 1.0); // N/m, a penalty coupling scales it
  const Plan plan = me.declare(mine);

  // 3. The plan says which of your points are coupled. Answer how light and how stiff they are:
  //    1/m for each component, and the row sum of M^-1 K, which is zero for free masses.
  Limits limits;
  limits.limited_by = "nothing, the masses are free";
  for (const Interface& interface : plan.interfaces) {
    limits.inverse_mass.emplace_back(interface.points.size() * dim, 1.0 / mass);
    limits.omega2.emplace_back(interface.points.size(), 0.0);
  }
  const Schedule schedule = me.initialize(limits);

  // 4. The same five calls in every step, whatever the coupling method.
  Rows x = mine.positions, v(x.size(), 0.0), f(x.size());
  while (me.has_next_step()) {
    for (std::size_t k = 0; k < plan.interfaces.size(); ++k) {
      const auto& mine_of_k = plan.interfaces[k].points;
      const auto position = me.position(k), velocity = me.velocity(k);
      for (std::size_t j = 0; j < position.size(); ++j) {
        position[j] = x[mine_of_k[j / dim] * dim + j % dim];
        velocity[j] = v[mine_of_k[j / dim] * dim + j % dim];
      }
    }
    me.publish_motion();
    f.assign(f.size(), 0.0); // your own forces: computed while the broker is at work
    for (std::size_t k = 0; plan.needs_own_forces && k < plan.interfaces.size(); ++k)
      for (double& component : me.own_forces(k))
        component = 0.0; // N
    me.publish_forces();
    me.receive();
    for (std::size_t k = 0; k < plan.interfaces.size(); ++k) {
      const auto force = me.interface_forces(k);
      for (std::size_t j = 0; j < force.size(); ++j)
        f[plan.interfaces[k].points[j / dim] * dim + j % dim] += force[j];
    }
    // Central differences; the first step starts from v^0 and makes half a step of it.
    const double dt = me.step() == 0 ? schedule.time_step / 2 : schedule.time_step;
    for (std::size_t j = 0; j < x.size(); ++j) {
      v[j] += f[j] / mass * dt;          // v^(n+1/2)
      x[j] += v[j] * schedule.time_step; // x^(n+1)
    }
  }
  me.finalize(nlohmann::json{{"points", points}}.dump());
  return 0;
}

} // namespace

int main(int argc, char** argv) try {
  std::size_t points = 1000;
  int dimension = 3;
  for (int i = 1; i + 1 < argc; i += 2) { // kerf-echo --points 1000 --dimension 3
    if (std::strcmp(argv[i], "--points") == 0)
      points = std::stoul(argv[i + 1]);
    else if (std::strcmp(argv[i], "--dimension") == 0)
      dimension = std::stoi(argv[i + 1]);
  }
  auto me = Participant::join("kerf-echo");
  try {
    return run(me, points, dimension);
  } catch (const RunStopped&) {
    throw;
  } catch (const std::exception& error) {
    me.fail(ErrorKind::failed, "", error.what()); // so that the user reads it
    throw;
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "kerf-echo: %s\n", error.what());
  return 3;
}
