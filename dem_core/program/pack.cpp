#include "dem_core/program/pack.hpp"

#include "common/exit_code.hpp"
#include "common/packing_file.hpp"
#include "dem_core/bonding.hpp"
#include "dem_core/packing/moduli.hpp"
#include "dem_core/packing/packing.hpp"
#include "dem_core/program/pack_arguments.hpp"
#include "dem_core/program/packing_cache.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <omp.h>

#include <fstream>
#include <iterator>
#include <map>
#include <optional>

namespace kerf::dem {

namespace {

struct Options {
  std::string region, periodic, radii, cut; // as pack_arguments.hpp reads them
  std::optional<std::size_t> count;
  double porosity = 0.0;
  std::uint64_t seed = 1;
  std::string from; // file, instead of region and radii
  std::optional<int> dimension;
  std::string out;
  std::optional<PackingFormat> format;
  std::vector<std::string> convert; // from and out
  bool has_moduli = false;
  std::string moduli_file;
  double normal_stiffness = 0.0, tangential_stiffness = 0.0; // N/m
  std::optional<double> gap_tolerance, coordination_number;  // exactly one of them
  std::optional<int> threads;
  bool use_cache = false;
};

const std::map<std::string, PackingFormat> formats = {{"text", PackingFormat::text},
                                                      {"yade", PackingFormat::yade},
                                                      {"vtk", PackingFormat::vtk},
                                                      {"dump", PackingFormat::dump}};

void add_options(CLI::App& app, Options& options) {
  const std::string make = "To make", take = "To take", measure = "To give";
  app.add_option("--region", options.region, std::string("What is filled: ") + region_words)
      ->group(make);
  app.add_option("--radii", options.radii, std::string("In m: ") + radii_words)->group(make);
  app.add_option("--porosity", options.porosity, "Share of the region outside of particles")
      ->group(make);
  app.add_option("--count", options.count, "Number of particles; the radii are scaled to it")
      ->group(make);
  app.add_option("--seed", options.seed, "Other seeds give other packings [1]")->group(make);
  app.add_option("--periodic", options.periodic, "Axes of a box without walls, as xy")->group(make);
  app.add_flag("--cache", options.use_cache, "Takes a packing that was made before")->group(make);
  app.add_option("--from", options.from, "Packing file, in any of the formats")->group(take);
  app.add_option("--dimension", options.dimension, "Of the file [2 when every z is zero]")
      ->check(CLI::IsMember({2, 3}))
      ->group(take);
  app.add_option("--cut", options.cut, "Keeps the particles with their centres in this region")
      ->group(measure);
  app.add_option("--out", options.out, "File: .vtk, .dump, .yade, or else text")->group(measure);
  app.add_option("--format", options.format, "Of the file, whatever its extension")
      ->transform(CLI::CheckedTransformer(formats))
      ->group(measure);
  app.add_option("--convert", options.convert, "Short for --from IN --out OUT")
      ->type_name("IN OUT")
      ->expected(2)
      ->group(measure);
  app.add_flag("--moduli", options.has_moduli, "Measures the elastic moduli of the bonded packing")
      ->group(measure);
  app.add_option("--moduli-file", options.moduli_file, "The same, also as JSON in this file")
      ->group(measure);
  app.add_option("--normal-stiffness", options.normal_stiffness, "Of a bond, N/m")
      ->check(CLI::PositiveNumber)
      ->group(measure);
  app.add_option("--tangential-stiffness", options.tangential_stiffness, "Of a bond, N/m [0]")
      ->check(CLI::NonNegativeNumber)
      ->group(measure);
  app.add_option("--gap-tolerance", options.gap_tolerance,
                 "Largest gap that is bonded, over the sum of the radii")
      ->check(CLI::NonNegativeNumber)
      ->group(measure);
  app.add_option("--coordination-number", options.coordination_number,
                 "Instead: 2 bonds / particles, which the gap follows from")
      ->check(CLI::PositiveNumber)
      ->group(measure);
  app.add_option("--threads", options.threads, "Number of threads [all cores]")
      ->check(CLI::PositiveNumber);
}

void check(Options& options) {
  if (!options.convert.empty()) {
    options.from = options.convert[0];
    options.out = options.convert[1];
  }
  if (options.from.empty() == options.region.empty())
    throw ArgumentError("give either --region with --radii and --porosity, or --from FILE");
  if (!options.region.empty() && (options.radii.empty() || options.porosity == 0.0))
    throw ArgumentError("--region needs --radii and --porosity");
  options.has_moduli = options.has_moduli || !options.moduli_file.empty();
  if (options.has_moduli &&
      (options.normal_stiffness == 0.0 ||
       options.gap_tolerance.has_value() == options.coordination_number.has_value()))
    throw ArgumentError("--moduli needs --normal-stiffness and either --gap-tolerance or "
                        "--coordination-number");
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Everything that decides a packing, in one line.
std::string description_of(const Options& options) {
  std::string region = options.region;
  if (region.starts_with("surface:"))
    region = "surface:" + fingerprint(content_of(region.substr(sizeof "surface:" - 1)));
  std::string text = fmt::format("kerf pack (version {}) --region {} --radii {} --porosity {}",
                                 packing_version, region, options.radii, options.porosity);
  if (options.count)
    text += fmt::format(" --count {}", *options.count);
  if (!options.periodic.empty())
    text += " --periodic " + options.periodic;
  return text + fmt::format(" --seed {}", options.seed);
}

template <int dim> ParticleSet<dim> to_particles(Packing packing) {
  ParticleSet<dim> particles;
  particles.radii = std::move(packing.radii);
  for (std::size_t i = 0; i < particles.radii.size(); ++i)
    particles.positions.emplace_back(Eigen::Map<const Vec<dim>>(&packing.positions[i * dim]));
  return particles;
}

template <int dim> Packing to_packing(const ParticleSet<dim>& particles) {
  Packing packing{.dim = dim, .positions = {}, .radii = particles.radii};
  for (const Vec<dim>& position : particles.positions)
    packing.positions.insert(packing.positions.end(), position.begin(), position.end());
  return packing;
}

template <int dim> ParticleSet<dim> make(const Options& options, const Region<dim>& region) {
  const std::string description = description_of(options);
  const std::filesystem::path cache = options.use_cache ? packing_cache() : "";
  if (!cache.empty())
    if (auto kept = find_packing(cache, description); kept && kept->dim == dim)
      return to_particles<dim>(std::move(*kept));
  ParticleSet<dim> particles = pack(region, {.radii = read_radii(options.radii),
                                             .porosity = options.porosity,
                                             .count = options.count,
                                             .seed = options.seed});
  if (!cache.empty())
    keep_packing(cache, description, to_packing(particles));
  return particles;
}

template <int dim>
void print_measures(const ParticleSet<dim>& particles, const Region<dim>* region) {
  const auto [least, most] = std::minmax_element(particles.radii.begin(), particles.radii.end());
  const PackingMeasures m = measure(particles, region == nullptr ? 1.0 : region->volume(),
                                    region == nullptr ? Period<dim>{} : region->period());
  fmt::print("  particles             {}\n", particles.radii.size());
  fmt::print("  radii                 {:.6g} to {:.6g} m\n", *least, *most);
  if (region != nullptr)
    fmt::print("  porosity              {:.4f}\n", m.porosity);
  fmt::print("  mean overlap          {:.3g} of the sum of the radii\n", m.mean_overlap);
  fmt::print("  largest overlap       {:.3g}\n", m.largest_overlap);
  fmt::print("  touching neighbours   {:.3f} a particle\n", m.coordination_number);
}

template <int dim> void print_moduli(const ParticleSet<dim>& particles, const Options& options) {
  const std::span<const Vec<dim>> x(particles.positions);
  const double gap = options.gap_tolerance ? *options.gap_tolerance
                                           : gap_tolerance_for<dim>(*options.coordination_number, x,
                                                                    particles.radii, {});
  const Moduli<dim> m =
      moduli<dim>(x, particles.radii, bonded_pairs<dim>(x, particles.radii, gap, {}),
                  options.normal_stiffness, options.tangential_stiffness);
  fmt::print("  gap tolerance         {:.6g}\n", gap);
  fmt::print("  coordination number   {:.4f}\n", m.coordination_number);
  fmt::print("  C11                   {:.6g} Pa\n", m.C11);
  fmt::print("  C12                   {:.6g} Pa\n", m.C12);
  fmt::print("  C66                   {:.6g} Pa\n", m.C66);
  fmt::print("  isotropy              {:.4f} = 2 C66 / (C11 - C12)\n", m.isotropy);
  fmt::print("  bulk density          {:.4f} of the particles' density\n", m.bulk_density_factor);
  if (options.moduli_file.empty())
    return;
  std::ofstream file(options.moduli_file);
  file << fmt::format(R"({{"C11": {}, "C12": {}, "C66": {}, "bulk_density_factor": {}}})", m.C11,
                      m.C12, m.C66, m.bulk_density_factor)
       << '\n';
  if (!file.flush())
    throw std::runtime_error("cannot write " + options.moduli_file);
}

template <int dim> void run(const Options& options) {
  std::unique_ptr<Region<dim>> region;
  ParticleSet<dim> particles;
  if (!options.region.empty()) {
    region = read_region<dim>(options.region, options.periodic);
    particles = make(options, *region);
  } else {
    particles = to_particles<dim>(read_packing(options.from, dim));
  }
  if (!options.cut.empty()) {
    region = read_region<dim>(options.cut);
    particles = cut(particles, *region);
    if (particles.radii.empty())
      throw ArgumentError(fmt::format("--cut {} holds no particle", options.cut));
  }
  print_measures<dim>(particles, region.get());
  if (options.has_moduli)
    print_moduli(particles, options);
  if (!options.out.empty()) {
    std::string comment =
        options.from.empty() ? description_of(options) : "kerf pack --from " + options.from;
    if (!options.cut.empty())
      comment += " --cut " + options.cut;
    write_packing(options.out, to_packing(particles),
                  options.format.value_or(packing_format(options.out)), comment);
    fmt::print("  written to            {}\n", options.out);
  }
}

} // namespace

int run_pack(int count, const char* const* arguments) {
  CLI::App app{
      "Makes a random packing of discs or spheres, or takes one from a file; cuts, converts "
      "and measures it.",
      "kerf pack"};
  Options options;
  add_options(app, options);
  try {
    app.parse(count - 1, arguments + 1);
    check(options);
    if (options.threads)
      omp_set_num_threads(*options.threads);
    int dimension = 0;
    if (!options.region.empty())
      dimension = dimension_of_region(options.region);
    else
      dimension = options.dimension ? *options.dimension : read_packing(options.from).dim;
    dimension == 2 ? run<2>(options) : run<3>(options);
    return exit_code::done;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_code::done : exit_code::bad_input;
  } catch (const std::runtime_error& error) { // arguments and files
    fmt::print(stderr, "kerf pack: {}.\n", error.what());
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "kerf pack: {}.\n", error.what());
  }
  return exit_code::bad_input;
}

} // namespace kerf::dem
