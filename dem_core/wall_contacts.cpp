#include "dem_core/wall_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kerf::dem {

namespace {

void check(const WallMaterial& material) {
  const auto must = [](bool holds, const char* what, double value) {
    if (!holds || !std::isfinite(value))
      throw std::invalid_argument(fmt::format("{}, not {}", what, value));
  };
  must(material.normal_stiffness > 0.0, "normal_stiffness must be positive",
       material.normal_stiffness);
  must(material.tangential_stiffness >= 0.0, "tangential_stiffness must not be negative",
       material.tangential_stiffness);
  must(material.friction >= 0.0, "friction must not be negative", material.friction);
}

/// The shortest rotation between two unit vectors, of a vector that is orthogonal to the first.
template <int dim> Vec<dim> carried(const Vec<dim>& F, const Vec<dim>& from, const Vec<dim>& to) {
  return F - (to.dot(F) / (1.0 + from.dot(to))) * (from + to);
}

/// Rotation about a unit vector, of a vector that is orthogonal to it.
template <int dim> Vec<dim> spun(const Vec<dim>& F, const Vec<dim>& axis, double angle) {
  if constexpr (dim == 2)
    return F;
  else
    return std::cos(angle) * F + std::sin(angle) * axis.cross(F);
}

/// Takes a moment or a rotation from one frame to another.
template <int dim>
Rot<dim> rotated(const Eigen::Matrix<double, dim, dim>& rotation, const Rot<dim>& vector) {
  if constexpr (dim == 2)
    return vector;
  else
    return rotation * vector;
}

} // namespace

/// How a particle has come to where it is, seen from the tool.
template <int dim> struct WallContacts<dim>::Approach {
  std::uint32_t particle;
  Vec<dim> centre, moved; // m
  Rot<dim> turned;        // rad

  /// Tangential displacement of the tool less that of the particle at the end of its arm, m.
  Vec<dim> slip(const Vec<dim>& normal, const Vec<dim>& arm) const {
    const Vec<dim> relative = -moved - spin<dim>(turned, arm);
    return relative - relative.dot(normal) * normal;
  }
  /// How far the particle has turned about a direction, rad.
  double spin_about(const Vec<dim>& direction) const {
    if constexpr (dim == 2)
      return 0.0;
    else
      return turned.dot(direction);
  }
};

template <int dim>
WallContacts<dim>::WallContacts(const WallMaterial& material, const Tool<dim>& tool,
                                const Particles<dim>& particles, double skin,
                                const Period<dim>& period)
    : material_(material), period_(period), middle_(tool.pose().start),
      extent_(std::numeric_limits<double>::infinity()), skin_(skin),
      blocks_(count_blocks(particles.size())) {
  check(material);
  if (const Surface<dim>* surface = tool.shape().surface()) {
    const Box<dim> box = bounding_box(*surface);
    middle_ = 0.5 * (box.lower + box.upper);
    extent_ = 0.0;
    for (const Vec<dim>& vertex : surface->vertices)
      extent_ = std::max(extent_, (vertex - tool.pose().start).norm());
  }
  renew(tool, particles);
  const std::vector<Aligned<Vec<dim>>> at_rest(particles.size());
  const std::vector<Aligned<Rot<dim>>> no_rotation(particles.size());
  const Increment<dim> nothing{at_rest, no_rotation, 1.0};
  Loads<dim> none;
  none.own.resize(particles.size());
  for (Block& block : blocks_) {
    compute_block(block, {tool, particles, nothing, 0.0}, none);
    if (material_.seated)
      for (std::size_t k = 0; k < block.now.size(); ++k) {
        block.now.contacts[k].rest_gap = block.now.places[k].gap;
        block.now.contacts[k].normal_force = 0.0;
      }
  }
  worn_ = skin_; // whatever moves the particles before the first step
}

template <int dim> void WallContacts<dim>::preload(std::span<const double> normal_force) {
  std::size_t next = 0;
  for (Block& block : blocks_)
    for (std::size_t k = 0; k < block.now.size(); ++k) {
      WallContact<dim>& contact = block.now.contacts[k];
      contact.normal_force = normal_force[next++];
      contact.shear_force.setZero();
      contact.rest_gap =
          block.now.places[k].gap - contact.normal_force / material_.normal_stiffness;
    }
}

/// The image of a position that may touch the tool.
template <int dim>
Vec<dim> WallContacts<dim>::image(const Tool<dim>& tool, const Vec<dim>& position) const {
  const Vec<dim> from_middle = position - tool.pose().to_space(middle_);
  return position + (period_.shortest(from_middle) - from_middle);
}

/// Lists the facets near the image, and near those that may take its place before the next list.
template <int dim>
void WallContacts<dim>::find_near(const Tool<dim>& tool, const Vec<dim>& position, double radius,
                                  std::vector<std::uint32_t>& found) const {
  const auto near = [&](const Vec<dim>& x, std::vector<std::uint32_t>& list) {
    tool.shape().near(tool.pose().to_body(x), radius + skin_, list);
  };
  std::vector<Vec<dim>> images = {image(tool, position)};
  const Vec<dim> from_middle = images.front() - tool.pose().to_space(middle_);
  for (int a = 0; a < dim; ++a)
    if (period_.length[a] > 0.0 && std::abs(from_middle[a]) > 0.5 * period_.length[a] - skin_)
      for (std::size_t count = images.size(), k = 0; k < count; ++k) {
        const double shift = std::copysign(period_.length[a], from_middle[a]);
        images.push_back(images[k] - shift * Vec<dim>::Unit(a));
      }
  near(images.front(), found);
  std::vector<std::uint32_t> more;
  for (std::size_t k = 1; k < images.size(); ++k) {
    near(images[k], more);
    found.insert(found.end(), more.begin(), more.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

template <int dim>
void WallContacts<dim>::renew(const Tool<dim>& tool, const Particles<dim>& particles) {
  const auto blocks = static_cast<std::int64_t>(blocks_.size());
  double farthest = 0.0; // from the reference point, m
#pragma omp parallel for schedule(static) reduction(max : farthest) if (blocks > 1)
  for (std::int64_t b = 0; b < blocks; ++b) {
    Block& block = blocks_[b];
    block.particles.clear();
    block.facet.clear();
    block.offset.assign(1, 0);
    std::vector<std::uint32_t> found;
    auto touching = block.now.contacts.begin();
    const auto [first, last] = particle_block(static_cast<std::size_t>(b), particles.size());
    for (std::size_t i = first; i < last; ++i) {
      const Vec<dim> centre = tool.pose().to_body(image(tool, particles.position(i)));
      found.clear();
      if (centre.allFinite()) {
        farthest = std::max(farthest, (centre - tool.pose().start).norm());
        find_near(tool, particles.position(i), particles.radius[i], found);
      }
      bool has_history = false;
      for (; touching != block.now.contacts.end() && touching->particle == i; ++touching)
        has_history = true;
      if (found.empty() && !has_history)
        continue;
      block.particles.push_back(static_cast<std::uint32_t>(i));
      block.facet.insert(block.facet.end(), found.begin(), found.end());
      block.offset.push_back(static_cast<std::uint32_t>(block.facet.size()));
    }
  }
  const double largest = *std::max_element(particles.radius.begin(), particles.radius.end());
  reach_ = std::min(farthest, extent_ + largest) + skin_;
  worn_ = 0.0;
}

template <int dim>
void WallContacts<dim>::begin_step(const Tool<dim>& tool, const Particles<dim>& particles,
                                   double time) {
  worn_ += time * (tool.velocity().translation.norm() + tool.velocity().rotation.norm() * reach_);
  if (worn_ >= skin_)
    renew(tool, particles);
}

template <int dim>
ToolLoad<dim> WallContacts<dim>::compute_block(Block& block, const Step& step,
                                               Loads<dim>& loads) const {
  const auto& [tool, particles, increment, time] = step;
  const Pose<dim>&pose = tool.pose(), &pose_before = tool.pose_before();
  const Eigen::Matrix<double, dim, dim> rotation_change = pose.rotation - pose_before.rotation;
  const Eigen::Matrix<double, dim, dim> half_way = 0.5 * (pose.rotation + pose_before.rotation);
  std::swap(block.now, block.before);
  block.now.clear();
  ToolLoad<dim> on_tool; // in the frame of the tool
  std::size_t old = 0;   // of block.before
  for (std::size_t k = 0; k < block.particles.size(); ++k) {
    const std::uint32_t i = block.particles[k];
    const Vec<dim> x = image(tool, particles.position(i));
    const Vec<dim> moved =
        increment.scale * increment.translation[i] - time * tool.velocity().translation;
    // y = R^T (x - reference) less the same of the step before, which loses no digits.
    const Approach approach{
        i, pose.to_body(x),
        rotation_change.transpose() * (x - pose.reference) +
            pose_before.rotation.transpose() * moved,
        rotated<dim>(half_way.transpose(), increment.scale * increment.rotation[i]) -
            time * tool.velocity().rotation};

    tool.shape().find_contacts(
        approach.centre, particles.radius[i],
        std::span(block.facet).subspan(block.offset[k], block.offset[k + 1] - block.offset[k]),
        block.found);
    const std::size_t first_old = old, first = block.now.size();
    while (old < block.before.size() && block.before.contacts[old].particle == i)
      ++old;
    touch(block, tool.shape(), approach, first_old, old);

    Load<dim> load; // in the frame of the tool
    for (std::size_t c = first; c < block.now.size(); ++c) {
      const WallContact<dim>& contact = block.now.contacts[c];
      const FacetContact<dim>& place = block.now.places[c];
      const Vec<dim> force = contact.normal_force * place.normal + contact.shear_force;
      load.force += force;
      load.moment += moment<dim>(place.point - approach.centre, force);
      on_tool.force -= force;
      on_tool.moment -= moment<dim>(place.point - pose.start, force);
      on_tool.stiffness += material_.normal_stiffness;
    }
    loads.own[i].force += pose.rotation * load.force;
    loads.own[i].moment += rotated<dim>(pose.rotation, load.moment);
  }
  on_tool.force = pose.rotation * on_tool.force;
  on_tool.moment = rotated<dim>(pose.rotation, on_tool.moment);
  return on_tool;
}

/// Goes on from the contacts first to last of the step before to those that were found now.
template <int dim>
void WallContacts<dim>::touch(Block& block, const ToolShape<dim>& shape, const Approach& approach,
                              std::size_t first, std::size_t last) const {
  if (first == last && block.found.empty())
    return;
  const std::span before = std::span(block.before.places).subspan(first, last - first);
  block.from.resize(block.found.size());
  shape.continue_contacts(before, block.found, block.from);
  continue_across_seam(block, approach, first, last);
  for (std::size_t k = 0; k < block.found.size(); ++k) {
    const bool is_new = block.from[k] == no_contact;
    const std::size_t old = first + (is_new ? 0 : block.from[k]);
    WallContact<dim> contact =
        is_new ? WallContact<dim>{.particle = approach.particle} : block.before.contacts[old];
    follow(contact, block.found[k], is_new ? nullptr : &block.before.places[old], approach,
           block.friction_loss);
    block.now.contacts.push_back(contact);
    block.now.places.push_back(block.found[k]);
  }
  for (std::uint32_t k = 0; k < before.size(); ++k)
    if (std::ranges::find(block.from, k) == block.from.end())
      end(block.before.contacts[first + k], before[k], approach, block.friction_loss);
}

/// Where another image of the particle counts now, it touches the same place of a tool that goes on
/// there with other facets: a contact with nearly the same normal continues.
template <int dim>
void WallContacts<dim>::continue_across_seam(Block& block, const Approach& approach,
                                             std::size_t first, std::size_t last) const {
  constexpr double least_cosine = 0.9;
  for (std::size_t k = 0; k < block.found.size(); ++k)
    for (std::size_t old = first; old < last && block.from[k] == no_contact; ++old) {
      const Vec<dim>& arm = block.before.contacts[old].arm;
      const FacetContact<dim>& place = block.before.places[old];
      const auto index = static_cast<std::uint32_t>(old - first);
      const Vec<dim> jump = approach.centre - approach.moved - (place.point - arm);
      const double cosine = place.normal.dot(block.found[k].normal);
      if (jump.norm() > arm.norm() && cosine > least_cosine &&
          std::ranges::find(block.from, index) == block.from.end())
        block.from[k] = index;
    }
}

/// The law. Halfway through the step is where the normal is the mean of both; the shear force
/// turns with the normal, and about it with the mean of particle and tool.
/// @param before  where the contact was in the step before, or null
template <int dim>
void WallContacts<dim>::follow(WallContact<dim>& contact, const FacetContact<dim>& now,
                               const FacetContact<dim>* before, const Approach& approach,
                               double& loss) const {
  const double k_n = material_.normal_stiffness, k_t = material_.tangential_stiffness;
  const Vec<dim>& n = now.normal;
  const Vec<dim> n_before = before ? before->normal : n;
  const Vec<dim> n_middle = (n_before + n).normalized();
  const Vec<dim> arm = now.point - approach.centre;
  const Vec<dim> arm_middle = before ? Vec<dim>(0.5 * (arm + contact.arm)) : arm;
  const Vec<dim> growth = k_t * approach.slip(n_middle, arm_middle);
  const double half_spin = 0.25 * approach.spin_about(n_middle);

  Vec<dim> trial = carried<dim>(contact.shear_force, n_before, n_middle);
  trial = spun<dim>(trial, n_middle, half_spin) + growth;
  trial = carried<dim>(spun<dim>(trial, n_middle, half_spin), n_middle, n);

  contact.arm = arm;
  contact.normal_force = std::min(0.0, k_n * (now.gap - contact.rest_gap));
  contact.shear_force = trial;
  const double limit = material_.friction * std::abs(contact.normal_force);
  const double size = trial.norm();
  if (size > limit) {
    contact.shear_force *= limit / size;
    // Work of a spring that gives way: mean force times the slip that is not elastic.
    const Vec<dim> twice_mean = trial - growth + contact.shear_force;
    loss += 0.5 * twice_mean.dot(trial - contact.shear_force) / k_t;
  }
}

/// A contact that opens gives its shear force away.
template <int dim>
void WallContacts<dim>::end(const WallContact<dim>& contact, const FacetContact<dim>& before,
                            const Approach& approach, double& loss) const {
  const double k_t = material_.tangential_stiffness;
  if (contact.shear_force.isZero(0.0))
    return;
  const Vec<dim> growth = k_t * approach.slip(before.normal, contact.arm);
  loss += 0.5 * contact.shear_force.dot(contact.shear_force + growth) / k_t;
}

template <int dim> std::size_t WallContacts<dim>::size() const noexcept {
  std::size_t count = 0;
  for (const Block& block : blocks_)
    count += block.now.size();
  return count;
}

template <int dim> double WallContacts<dim>::elastic_energy() const {
  double energy = 0.0;
  for_each([&](const WallContact<dim>& contact, const FacetContact<dim>&) {
    energy += 0.5 * contact.normal_force * contact.normal_force / material_.normal_stiffness;
    if (material_.tangential_stiffness > 0.0)
      energy += 0.5 * contact.shear_force.squaredNorm() / material_.tangential_stiffness;
  });
  return energy;
}

template <int dim> double WallContacts<dim>::friction_loss() const {
  double loss = 0.0;
  for (const Block& block : blocks_)
    loss += block.friction_loss;
  return loss;
}

template class WallContacts<2>;
template class WallContacts<3>;

} // namespace kerf::dem
