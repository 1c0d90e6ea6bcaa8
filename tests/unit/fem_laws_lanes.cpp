// Laws in the lanes of every set of instructions: like one point at a time, and undisturbed by
// what the other lanes do.
#include "common/instruction_set.hpp"
#include "fem_core/laws/plane_stress.hpp"
#include "fem_core/laws/transversely_isotropic.hpp"
#include "tests/cases/law_point.hpp"
#include "tests/unit/fem_laws_kernel.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace kerf {
namespace {

using cases::Random;
using cases::ScalarMath;
using fem::DruckerPrager;
using fem::Hardening;
using fem::IsotropicDamage;
using fem::IsotropicElastic;
using fem::J2Plastic;
using fem::NeoHookean;
using fem::PlaneStress;
using fem::TransverselyIsotropic;

std::vector<InstructionSet> sets() {
  std::vector<InstructionSet> known{InstructionSet::baseline};
  if (best_instruction_set() != InstructionSet::baseline)
    known.push_back(InstructionSet::avx2);
  if (best_instruction_set() == InstructionSet::avx512)
    known.push_back(InstructionSet::avx512);
  return known;
}
template <class Function>
Function of(InstructionSet set, Function baseline, Function avx2, Function avx512) {
  return set == InstructionSet::avx512 ? avx512 : set == InstructionSet::avx2 ? avx2 : baseline;
}

template <class Law>
concept Hyperelastic = requires(const Law& law, const fem::Gradient<double, 2>& H) {
  law.template kirchhoff<ScalarMath, 2>(H);
};

/// Points of a random walk, in columns, and what a law makes of them.
template <class Law, int dim> struct Points {
  static constexpr int count = 64, stresses = dim == 2 ? 4 : 6;
  static constexpr int inputs = !Hyperelastic<Law> ? stresses : dim == 2 ? 5 : 9;
  static constexpr int histories = Law::history;

  std::vector<double> stress = std::vector<double>(stresses * count);
  std::vector<double> history = std::vector<double>(histories * count);
  std::vector<double> input = std::vector<double>(inputs * count);
  std::vector<double> dissipated = std::vector<double>(count);
  double time_step = 1e-5; // s

  explicit Points(const Law& law) {
    const auto initial = law.initial_history(1e-3);
    for (int h = 0; h < histories; ++h)
      std::fill_n(history.begin() + h * count, count, initial[h]);
  }
  /// Some points move much and some little: part of them flows.
  void draw(Random& random, double size) {
    for (int k = 0; k < count; ++k) {
      const double own = size * std::pow(10.0, random());
      for (int c = 0; c < inputs; ++c)
        input[c * count + k] = own * random();
    }
  }
  PointColumns columns() {
    return {count, stress.data(), history.data(), input.data(), dissipated.data(), time_step};
  }
  void run_lanes(const Law& law, InstructionSet set) {
    of(set, &baseline::run_points<Law, dim>, &avx2::run_points<Law, dim>,
       &avx512::run_points<Law, dim>)(law, columns());
  }
  void run_one_by_one(const Law& law) {
    for (int k = 0; k < count; ++k) {
      const auto read = [&](int c) { return input[c * count + k]; };
      fem::Symmetric<double, dim> sigma;
      if constexpr (Hyperelastic<Law>) {
        fem::Gradient<double, dim> H;
        if constexpr (dim == 2)
          H = {read(0), read(1), read(2), read(3), read(4)};
        else
          H = {read(0), read(1), read(2), read(3), read(4), read(5), read(6), read(7), read(8)};
        sigma = law.template kirchhoff<ScalarMath, dim>(H);
        dissipated[k] = law.template energy_density<ScalarMath, dim>(H);
      } else {
        fem::Symmetric<double, dim> increment;
        for (int c = 0; c < stresses; ++c) {
          sigma[c] = stress[c * count + k];
          increment[c] = read(c);
        }
        std::array<double, histories + 1> kept{};
        for (int h = 0; h < histories; ++h)
          kept[h] = history[h * count + k];
        dissipated[k] =
            law.template update<ScalarMath, dim>(sigma, kept.data(), increment, time_step);
        for (int h = 0; h < histories; ++h)
          history[h * count + k] = kept[h];
      }
      for (int c = 0; c < stresses; ++c)
        stress[c * count + k] = sigma[c];
    }
  }
  /// The points in the order k -> (stride k) mod count, so that each has other neighbours.
  Points shuffled(int stride) const {
    Points other = *this;
    const auto shuffle = [&](const std::vector<double>& from, std::vector<double>& to) {
      for (std::size_t c = 0; c < from.size(); c += count)
        for (int k = 0; k < count; ++k)
          to[c + k] = from[c + k * stride % count];
    };
    shuffle(stress, other.stress);
    shuffle(history, other.history);
    shuffle(input, other.input);
    shuffle(dissipated, other.dissipated);
    return other;
  }
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::bit_cast<std::uint64_t>(a[k]) != std::bit_cast<std::uint64_t>(b[k]))
      return false;
  return a.size() == b.size();
}
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0, scale = std::numeric_limits<double>::min();
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, std::abs(a[k] - b[k]));
    scale = std::max(scale, std::abs(a[k]));
  }
  return largest / scale;
}

/// Tolerance: rounding in ten increments; logarithm and exponential of the lanes are their own.
template <int dim, class Law> void lanes_are_points(const Law& law, double size) {
  for (const InstructionSet set : sets()) {
    SCOPED_TRACE(name_of(set));
    Random random;
    Points<Law, dim> lanes(law), one_by_one(law);
    for (int n = 0; n < 10; ++n) {
      lanes.draw(random, size);
      one_by_one.input = lanes.input;
      auto others = lanes.shuffled(27), alone = lanes; // 27: odd
      for (int k = 0; k < alone.count; ++k)            // every fifth point among points at rest
        for (int c = 0; c < alone.inputs && k % 5 != 0; ++c)
          alone.input[c * alone.count + k] = 0.0;

      lanes.run_lanes(law, set);
      others.run_lanes(law, set);
      alone.run_lanes(law, set);
      one_by_one.run_one_by_one(law);

      const auto expected = lanes.shuffled(27);
      ASSERT_TRUE(same_bits(others.stress, expected.stress));
      ASSERT_TRUE(same_bits(others.history, expected.history));
      ASSERT_TRUE(same_bits(others.dissipated, expected.dissipated));
      for (int k = 0; k < alone.count; k += 5)
        for (int c = 0; c < alone.stresses; ++c)
          ASSERT_EQ(alone.stress[c * alone.count + k], lanes.stress[c * alone.count + k]);
      ASSERT_LT(largest_difference(lanes.stress, one_by_one.stress), 1e-14);
      ASSERT_LT(largest_difference(lanes.dissipated, one_by_one.dissipated), 1e-14);
      for (int h = 0; h < lanes.histories; ++h) {
        const auto column = [&](const std::vector<double>& all) {
          const auto begin = all.begin() + h * lanes.count;
          return std::vector<double>(begin, begin + lanes.count);
        };
        ASSERT_LT(largest_difference(column(lanes.history), column(one_by_one.history)), 1e-14);
      }
    }
  }
}

TEST(LawLanes, elastic_laws_have_the_same_bits_whatever_the_other_lanes_do) {
  const TransverselyIsotropic::Parameters slate{.density = 2700.0,
                                                .young_in_plane = 60e9,
                                                .young_normal = 25e9,
                                                .poisson_in_plane = 0.22,
                                                .poisson_normal = 0.28,
                                                .shear_normal = 12e9,
                                                .axis = {1.0, 2.0, 0.0}};
  lanes_are_points<2>(cases::rock(), 1e-4);
  lanes_are_points<3>(cases::rock(), 1e-4);
  lanes_are_points<2>(PlaneStress(cases::rock()), 1e-4);
  lanes_are_points<2>(TransverselyIsotropic::from(slate, 2), 1e-4);
  lanes_are_points<3>(TransverselyIsotropic::from(slate, 3), 1e-4);
  const auto rubber = NeoHookean::from(cases::rock());
  for (const double size : {1e-10, 0.02}) {
    lanes_are_points<2>(rubber, size);
    lanes_are_points<3>(rubber, size);
    lanes_are_points<2>(PlaneStress(rubber), size);
  }
}
TEST(LawLanes, plastic_laws_have_the_same_bits_whatever_the_other_lanes_do) {
  const std::vector<double> strain{0.0, 1e-3, 4e-3, 0.02}, stress{300e6, 340e6, 350e6, 500e6};
  const auto rate = fem::RateDependence::cowper_symonds(40.4, 5.0);
  for (const auto& hardening : {Hardening::linear(300e6, 5e9), Hardening::voce(300e6, 150e6, 200.0),
                                Hardening::table(strain, stress)})
    for (const auto& rated : {fem::RateDependence{}, rate}) {
      const auto law = J2Plastic::from(cases::steel(), hardening, rated);
      lanes_are_points<2>(law, 2e-3);
      lanes_are_points<3>(law, 2e-3);
      lanes_are_points<2>(PlaneStress(law), 2e-3);
    }
}
TEST(LawLanes, laws_of_rock_have_the_same_bits_whatever_the_other_lanes_do) {
  for (const double cutoff : {-1.0, 2e6}) {
    auto parameters = cases::sandstone();
    parameters.tension_cutoff = cutoff;
    const auto law = DruckerPrager::from(cases::rock(), parameters);
    lanes_are_points<2>(law, 1e-3);
    lanes_are_points<3>(law, 1e-3);
    lanes_are_points<2>(PlaneStress(law), 1e-3);
  }
  lanes_are_points<2>(cases::brittle_rock(), 1e-4);
  lanes_are_points<3>(cases::brittle_rock(), 1e-4);
  lanes_are_points<2>(PlaneStress(cases::brittle_rock()), 1e-4);
}

/// Largest error in units in the last place, against long double.
double worst_ulps(InstructionSet set, LaneFunction function, const std::vector<double>& x) {
  std::vector<double> y(x.size());
  of(set, &baseline::apply, &avx2::apply, &avx512::apply)(function, x.data(), y.data(),
                                                          static_cast<int>(x.size()));
  double worst = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const long double at = x[k];
    const long double exact = function == LaneFunction::logarithm     ? std::log(at)
                              : function == LaneFunction::exponential ? std::exp(at)
                                                                      : std::log1p(at);
    const double size = std::abs(static_cast<double>(exact));
    const double ulp = std::nextafter(size, INFINITY) - size;
    worst = std::max(worst, static_cast<double>(std::abs(y[k] - exact)) / ulp);
  }
  return worst;
}

// Reference: the functions of the standard library in long double.
TEST(LaneMath, logarithm_and_exponential_are_right_to_two_units_in_the_last_place) {
  constexpr int count = 1 << 16;
  Random random;
  std::vector<double> normal(count), near_one(count), exponents(count), tiny(count);
  for (int k = 0; k < count; ++k) {
    normal[k] = std::exp2(1022.0 * random()) * (1.0 + 0.5 * random());
    near_one[k] = 1.0 + random() * std::exp2(26.0 * random() - 26.5);
    exponents[k] = 708.0 * random() * std::exp2(30.0 * random() - 30.0);
    tiny[k] = 0.9 * random() * std::exp2(60.0 * random() - 60.0);
  }
  for (const InstructionSet set : sets()) {
    SCOPED_TRACE(name_of(set));
    const double logarithm = std::max(worst_ulps(set, LaneFunction::logarithm, normal),
                                      worst_ulps(set, LaneFunction::logarithm, near_one));
    const double exponential = worst_ulps(set, LaneFunction::exponential, exponents);
    const double of_one_plus =
        std::max(worst_ulps(set, LaneFunction::logarithm_of_one_plus, tiny),
                 worst_ulps(set, LaneFunction::logarithm_of_one_plus, normal));
    EXPECT_LT(logarithm, 1.0);
    EXPECT_LT(exponential, 1.0);
    EXPECT_LT(of_one_plus, 2.0);
    RecordProperty(std::string("ulps_") + name_of(set), std::to_string(logarithm) + " " +
                                                            std::to_string(exponential) + " " +
                                                            std::to_string(of_one_plus));
  }
}

TEST(LaneMath, the_ends_of_the_range_are_exact_and_outside_is_not_a_number) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const InstructionSet set : sets()) {
    SCOPED_TRACE(name_of(set));
    const auto apply = of(set, &baseline::apply, &avx2::apply, &avx512::apply);
    const std::vector<double> x{1.0, 0.0, -1.0, inf, -0.0, std::nan(""), 1e-310, -inf};
    std::vector<double> y(x.size());
    apply(LaneFunction::logarithm, x.data(), y.data(), 8);
    EXPECT_EQ(y[0], 0.0);
    for (int k = 1; k < 8; ++k)
      EXPECT_TRUE(std::isnan(y[k])) << k;
    const std::vector<double> powers{0.0, 710.0, -710.0, inf, -inf, std::nan(""), -1e-300, 1.0};
    apply(LaneFunction::exponential, powers.data(), y.data(), 8);
    EXPECT_EQ(y[0], 1.0);
    EXPECT_EQ(y[1], inf);
    EXPECT_EQ(y[2], 0.0);
    EXPECT_EQ(y[3], inf);
    EXPECT_EQ(y[4], 0.0);
    EXPECT_TRUE(std::isnan(y[5]));
    EXPECT_EQ(y[6], 1.0);
  }
}

} // namespace
} // namespace kerf
