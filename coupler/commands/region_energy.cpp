#include "coupler/commands/region_energy.hpp"

#include "common/results.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace kerf::commands {
namespace {

using Point = std::array<double, 3>;

Frame last_frame(const std::filesystem::path& run_folder, const std::string& participant) {
  const std::vector<FrameFile> frames = list_frames(run_folder, participant);
  if (frames.empty())
    throw std::runtime_error(fmt::format("\"{}\" wrote no frame to measure: let case.output.frames "
                                         "be at least 1",
                                         participant));
  return read_frame(frames.back().path);
}

class Box {
public:
  explicit Box(const nlohmann::json& box) {
    if (box.is_null())
      return;
    for (std::size_t k = 0; k < box[0].size(); ++k) {
      low_[k] = box[0][k];
      high_[k] = box[1][k];
    }
  }
  bool contains(const Point& x) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (x[k] < low_[k] || x[k] > high_[k])
        return false;
    return true;
  }

private:
  Point low_{-INFINITY, -INFINITY, -INFINITY}, high_{INFINITY, INFINITY, INFINITY};
};

Point row(const Array& array, std::size_t i) {
  Point point{};
  for (std::size_t k = 0; k < std::min<std::size_t>(array.columns, 3); ++k)
    point[k] = array.reals()[i * array.columns + k];
  return point;
}

/// Reference position of each point.
std::vector<Point> origins(const Frame& frame, const std::string& grid) {
  const Array &position = frame.at(grid + "/position"),
              &displacement = frame.at(grid + "/displacement");
  std::vector<Point> result(position.rows);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Point x = row(position, i), u = row(displacement, i);
    for (std::size_t k = 0; k < 3; ++k)
      result[i][k] = x[k] - u[k];
  }
  return result;
}

/// |a_i - factor b_j|²
double squared_difference(const Array& a, std::size_t i, const Array& b, std::size_t j,
                          double factor) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.columns; ++k) {
    const double difference = a.reals()[i * a.columns + k] -
                              (factor != 0.0 ? factor * b.reals()[j * b.columns + k] : 0.0);
    sum += difference * difference;
  }
  return sum;
}

/// For each particle of one body the particle of the other that started at the same place.
std::vector<std::size_t> matches(const std::vector<Point>& a, const std::vector<Point>& b,
                                 double resolution) {
  using Key = std::array<long, 3>;
  const auto key = [&](const Point& x) {
    return Key{std::lround(x[0] / resolution), std::lround(x[1] / resolution),
               std::lround(x[2] / resolution)};
  };
  std::map<Key, std::size_t> at;
  for (std::size_t j = 0; j < b.size(); ++j)
    at.emplace(key(b[j]), j);
  std::vector<std::size_t> match(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    if (const auto found = at.find(key(a[i])); found != at.end())
      match[i] = found->second;
  return match;
}

double particle_energy(const Frame& frame, const Frame* reference, const Box& box, int dimension) {
  const std::vector<Point> X = origins(frame, "particles");
  const Frame& other = reference ? *reference : frame;
  const Array &mass = frame.at("particles/mass"), &radius = frame.at("particles/radius");
  std::vector<std::size_t> match(X.size(), X.size());
  if (reference) {
    const std::vector<Point> other_X = origins(other, "particles");
    match = matches(X, other_X, 0.01 * radius.reals().at(0));
    for (std::size_t i = 0; i < X.size(); ++i)
      if (box.contains(X[i]) && match[i] == other_X.size())
        throw std::invalid_argument(fmt::format("the reference has no particle at ({}, {}, {}) m",
                                                X[i][0], X[i][1], X[i][2]));
  }
  double energy = 0.0;
  for (std::size_t i = 0; i < X.size(); ++i) {
    if (!box.contains(X[i]))
      continue;
    const double m = mass.reals()[i], r = radius.reals()[i];
    const double inertia = (dimension == 2 ? 0.5 : 0.4) * m * r * r; // disc, sphere
    for (const auto& [field, factor] :
         {std::pair{"particles/velocity", m}, std::pair{"particles/angular_velocity", inertia}})
      energy +=
          0.5 * factor *
          squared_difference(frame.at(field), i, other.at(field), match[i], reference ? 1.0 : 0.0);
  }

  using Pair = std::pair<std::size_t, std::size_t>;
  const auto ordered = [](std::size_t i, std::size_t j) { return Pair(std::minmax(i, j)); };
  const auto pair_of = [&](const Frame& f, std::size_t c) {
    const std::vector<std::int64_t>& cells = f.at("contacts/cells").integers();
    return ordered(static_cast<std::size_t>(cells[2 * c]),
                   static_cast<std::size_t>(cells[2 * c + 1]));
  };
  std::map<Pair, std::size_t> other_contact;
  if (reference)
    for (std::size_t c = 0; c < other.at("contacts/cells").rows; ++c)
      other_contact.emplace(pair_of(other, c), c);
  const auto& k_n = frame.at("contacts/normal_stiffness").reals();
  const auto& k_t = frame.at("contacts/tangential_stiffness").reals();
  const auto& weight = frame.at("contacts/weight").reals();
  for (std::size_t c = 0; c < k_n.size(); ++c) {
    const auto [i, j] = pair_of(frame, c);
    Point middle{};
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] = 0.5 * (X[i][k] + X[j][k]);
    if (!box.contains(middle))
      continue;
    std::size_t partner = 0;
    double turned = 0.0; // none; or -1 where the reference sees the pair from its other end
    if (reference) {
      const auto found = other_contact.find(ordered(match[i], match[j]));
      if (found != other_contact.end()) {
        partner = found->second;
        turned = match[i] < match[j] ? 1.0 : -1.0;
      }
    }
    const double k_normal = k_n[c], k_tangential = k_t[c];
    energy += 0.5 * weight[c] / k_normal *
              squared_difference(frame.at("contacts/normal_force"), c,
                                 other.at("contacts/normal_force"), partner, std::abs(turned));
    if (k_tangential > 0.0)
      energy += 0.5 * weight[c] / k_tangential *
                squared_difference(frame.at("contacts/tangential_force"), c,
                                   other.at("contacts/tangential_force"), partner, turned);
  }
  return energy;
}

double mesh_energy(const Frame& frame, const Box& box) {
  const std::vector<Point> X = origins(frame, "mesh");
  const auto& mass = frame.at("mesh/mass").reals();
  const Array& velocity = frame.at("mesh/velocity");
  double energy = 0.0;
  for (std::size_t n = 0; n < X.size(); ++n)
    if (box.contains(X[n]))
      energy += 0.5 * mass[n] * squared_difference(velocity, n, velocity, n, 0.0);
  const Array& cells = frame.at("mesh/cells");
  const auto& elastic = frame.at("mesh/elastic_energy").reals();
  for (std::size_t e = 0; e < cells.rows; ++e) {
    Point centre{};
    for (std::size_t a = 0; a < cells.columns; ++a)
      for (std::size_t k = 0; k < 3; ++k)
        centre[k] += X[static_cast<std::size_t>(cells.integers()[e * cells.columns + a])][k] /
                     static_cast<double>(cells.columns);
    if (box.contains(centre))
      energy += elastic[e];
  }
  return energy;
}

} // namespace

double energy_in_region(const std::filesystem::path& run_folder, const nlohmann::json& settings,
                        const nlohmann::json& m) {
  const std::string participant = m.at("participant");
  const Frame frame = last_frame(run_folder, participant);
  const Box box(m.at("box"));
  const bool particles = settings.at("participants").at(participant).at("kind") == "dem";
  if (m.at("reference").is_null())
    return particles ? particle_energy(frame, nullptr, box, settings.at("case").at("dimension"))
                     : mesh_energy(frame, box);
  if (!particles)
    throw std::invalid_argument(
        fmt::format("measure \"{}\": a reference can stand in for particles only",
                    m.at("name").get<std::string>()));
  const Frame reference = last_frame(run_folder, m.at("reference"));
  return particle_energy(frame, &reference, box, settings.at("case").at("dimension"));
}

} // namespace kerf::commands
