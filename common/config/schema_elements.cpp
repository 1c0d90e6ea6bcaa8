// The keys of what acts on a body of elements beside prescribed motions: loads, dashpots, rigid
// walls; and of its probes.
#include "common/config/schema_rows.hpp"

namespace kerf::config {
namespace {

std::vector<Key> load_keys() {
  using enum Type;
  const std::string key = "participants.*.loads";
  return {
      {key, "fem", list, "", empty, anything, "load", "a force on nodes or faces; several add up"},
      {key + "[].tag", "fem", text, "", none, anything, R"("right")",
       "the tag of the faces or nodes that it acts on; exactly one of tag and box", live},
      {key + "[].box", "fem", box, "m", none, anything, "[[-1.0, -1.0], [1.0, 1.0]]",
       "the lower and upper corner around the nodes that it acts on, before they move"},
      {key + "[].force", "fem", vector, "N", none, anything, "[0.0, -1e3]",
       "the force in all, spread over faces by their area, else evenly over the nodes; in 2D per "
       "metre of thickness"},
      {key + "[].forces", "fem", vectors_of_time, "s, N", none, anything,
       "[[0.0, 0.0, 0.0], [1e-5, 0.0, -1e3]]",
       "instead of force: a table of it, linear between its times and constant beyond"},
      {key + "[].traction", "fem", vector, "Pa", none, anything, "[1e6, 0.0]",
       "a force per area of the undeformed faces"},
      {key + "[].tractions", "fem", vectors_of_time, "s, Pa", none, anything,
       "[[0.0, 0.0, 0.0], [1e-5, 1e6, 0.0]]", "instead of traction: a table of it"},
      {key + "[].pressure", "fem", number, "Pa", none, anything, "1e6",
       "a pressure on the faces as they deform, positive into the body", live},
      {key + "[].pressures", "fem", numbers_of_time, "s, Pa", none, anything,
       "[[0.0, 0.0], [1e-5, 1e6]]", "instead of pressure: a table of it"},
  };
}

std::vector<Key> absorbing_keys() {
  using enum Type;
  const std::string key = "participants.*.absorbing";
  return {
      {key, "fem", list, "", empty, anything, "absorbing boundary",
       "a boundary that lets waves out, as if the body went on behind it"},
      {key + "[].tag", "fem", text, "", required, anything, R"("bottom")", "the tag of its faces"},
      {key + "[].wave", "fem", optional_table, "", none, anything, "incoming wave",
       "a plane wave that comes in through it"},
      {key + "[].wave.direction", "fem", vector, "", required, anything, "[0.0, 1.0]",
       "the direction in which it travels, of any length"},
      {key + "[].wave.polarization", "fem", vector, "", none, anything, "[1.0, 0.0]",
       "the direction in which the solid moves: along that of travel, as when not given, it is a P "
       "wave, across it an S wave"},
      {key + "[].wave.origin", "fem", vector, "m", none, anything, "[0.0, 0.0]",
       "the point where its time begins; the first of the boundary that it reaches when not given"},
      {key + "[].wave.velocity", "fem", number, "m/s", none, anything, "1e-3",
       "the largest velocity of the solid in a Hann pulse", live},
      {key + "[].wave.duration", "fem", number, "s", none, in(above_zero), "1e-5",
       "how long that pulse takes", live},
      {key + "[].wave.velocities", "fem", numbers_of_time, "s, m/s", none, anything,
       "[[0.0, 0.0], [5e-6, 1e-3], [1e-5, 0.0]]",
       "instead of a pulse: a table of the velocity, linear between its times"},
  };
}

std::vector<Key> wall_keys() {
  using enum Type;
  const std::string key = "participants.*.walls";
  return {
      {key, "fem", list, "", empty, anything, "rigid wall", "a rigid plane that nodes do not pass"},
      {key + "[].name", "fem", name, "", required, anything, R"("anvil")", "a name, used once"},
      {key + "[].tag", "fem", text, "", required, anything, R"("left")",
       "the tag of the nodes that it holds back"},
      {key + "[].point", "fem", vector, "m", required, anything, "[0.0, 0.0]",
       "a point of the plane at the start"},
      {key + "[].normal", "fem", vector, "", required, anything, "[1.0, 0.0]",
       "the direction from the wall to the body, of any length"},
      {key + "[].friction", "fem", number, "", "0.0", in(from_zero), "0.3",
       "the coefficient of Coulomb friction"},
      {key + "[].velocity", "fem", number, "m/s", none, anything, "0.1",
       "its velocity along the normal; it rests when not given"},
      {key + "[].velocities", "fem", numbers_of_time, "s, m/s", none, anything,
       "[[0.0, 0.0], [1e-5, 0.1]]", "a table of that velocity, linear between its times"},
  };
}

std::vector<Key> probe_keys() {
  using enum Type;
  const std::string key = "participants.*.probes";
  return {
      {key, "fem", list, "", empty, anything, "probe",
       "a point of the body whose motion and stress are recorded"},
      {key + "[].name", "fem", name, "", required, anything, R"("tip")", "a name, used once"},
      {key + "[].point", "fem", vector, "m", required, anything, "[0.08, 0.003]",
       "where it is in the body before that moves"},
  };
}

} // namespace

std::vector<Key> action_keys() {
  std::vector<Key> keys;
  for (const auto& part : {load_keys(), absorbing_keys(), wall_keys(), probe_keys()})
    keys.insert(keys.end(), part.begin(), part.end());
  return keys;
}

} // namespace kerf::config
